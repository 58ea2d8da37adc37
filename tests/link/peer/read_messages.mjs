// SPDX-License-Identifier: Apache-2.0
// Decodes the packets of write_messages (stdin) with node-mavlink and compares every field.
import { createInterface } from 'node:readline'
import { Readable } from 'node:stream'
import { ardupilotmega, common, createMavLinkStream, minimal, standard } from 'node-mavlink'

const registry = { ...minimal.REGISTRY, ...standard.REGISTRY, ...common.REGISTRY,
                   ...ardupilotmega.REGISTRY }

const written = []
for await (const line of createInterface({ input: process.stdin })) {
  written.push(JSON.parse(line))
}

const same = (is, expected) =>
  Array.isArray(expected) ? expected.every((value, n) => same(is[n], value))
  : typeof expected === 'string' ? String(is) === expected
  : Number.isInteger(expected) ? Number(is) === expected : Math.fround(is) === Math.fround(expected)

let count = 0
const problems = []
const packets = createMavLinkStream(Readable.from(written.map(one => Buffer.from(one.packet, 'hex'))))
for await (const packet of packets) {
  const { name, fields } = written[count++]
  const definition = registry[packet.header.msgid]
  const message = packet.protocol.data(packet.payload, definition)
  if (definition.MSG_NAME !== name) {
    problems.push(`${name} arrived as ${definition.MSG_NAME}`)
    continue
  }
  for (const field of definition.FIELDS) {
    if (!same(message[field.name], fields[field.source])) {
      problems.push(`${name}.${field.source}: sent ${fields[field.source]}, read ${message[field.name]}`)
    }
  }
  if (definition.FIELDS.length !== Object.keys(fields).length) {
    problems.push(`${name}: ${definition.FIELDS.length} fields, sent ${Object.keys(fields).length}`)
  }
}
if (count === 0 || count !== written.length) {
  problems.push(`${written.length} packets sent, ${count} read`)
}
console.log(problems.slice(0, 20).join('\n') || `${count} packets read alike`)
process.exit(problems.length === 0 ? 0 : 1)
