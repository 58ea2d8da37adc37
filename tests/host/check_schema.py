# SPDX-License-Identifier: Apache-2.0
"""check_schema.py SCHEMA CASES: the schema is valid draft-07, and judges each case as expected.

CASES is a JSON list of {"fits": bool, "file": document}. Prints what differs; exit code 1 then.
"""
import json
import sys

import jsonschema

with open(sys.argv[1]) as stream:
    schema = json.load(stream)
with open(sys.argv[2]) as stream:
    cases = json.load(stream)
jsonschema.Draft7Validator.check_schema(schema)
validator = jsonschema.Draft7Validator(schema)
wrong = 0
for case in cases:
    errors = [error.message for error in validator.iter_errors(case["file"])]
    if case["fits"] != (not errors):
        wrong += 1
        print("expected to fit" if case["fits"] else "expected not to fit",
              json.dumps(case["file"]), errors)
sys.exit(1 if wrong else 0)
