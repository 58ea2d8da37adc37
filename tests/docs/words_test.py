#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""words_test.py ROOT [--print]: no string, key or page uses a former word of the project where the field
has one; --print writes all of them to stdout, to be read.

Common words are matched by the phrases in which they had the former sense. An exception is a file and
a phrase of it, with the reason why the word is right there.
"""
import pathlib
import re
import sys

FORMER = {  # pattern: what to write instead
    r"goal_share": "goal_bias",
    r"--patience": "--timeout",
    r"\bpatience\b": "timeout",
    r"\"stands\"|\.stands\b|`stands`|\broutes? (that )?stands?\b|\bstood\b": "accepted",
    r"\bun?sound (route|leg|track|path)s?\b": "valid",
    r"\b(planner|session|smoother|tuner|pilot|environment|constraint|interface|ground)'?s? laws?\b"
    r"|\blaws? (of (its|the|their) interfaces?|\d)\b": "contract",
    r"\bblam(e|ed|es|ing)\b": "attributed to, caused by",
    r"cross[_-]examin": "consistency check",
    r"\bdrawn (city|cities|map|maps|world|worlds|zones?|obstacles?)\b": "generated, random",
    r"\blast words\b": "crash report",
    r"\bwardens?\b": "supervisor",
    r"\bblackboard\b": "worker status",
    r"\bharvest": "recover",
    r"\bforeign routes?\b": "imported route",
    r"too_dear|\btoo dear\b": "exceeds_incumbent",
    r"\bslack of (a|the|its) layer|\blayers?'s? slack|\bits slack\b": "over-approximation",
    r"plane: space\b|\bin the plane and in space\b": "2-D, 3-D (planar, spatial)",
    r"\bshall be (least|greatest)\b|\bbe least\b": "to minimise",
    r"\bwhatever the tuner\b|\bat most so many\b": "maximum number of …",
    r"\bmay come to\b|\bwhat (a run|it) came to\b": "outcome",
    r"\bshortest ways?\b|\bways? (of|in) (a|the) (search|tree)\b|\btree whose ways\b": "path",
    r"\b(keep|keeps|kept|break|breaks|broke|broken|obey|obeys) (a|the|its|all|every|each|some) "
    r"(route )?rules?\b": "constraint",
    r"\bprogram (tells|says|told|said)\b|\bwhat (it|the program) (tells|told)\b": "reports, prints",
    r"\btoo short to compress\b|\blets? go of it\b|\bdone again\b": "the glossary's sentences",
}
REFUSED = "a former name, refused with the present one"
STORED = "read to refuse it by its former name"
EXCEPTIONS = {
    ("framework/include/altiplan/kit/sampling/star_params.hpp", "goal_share"): REFUSED,
    ("plugins/planner/rrt/rrt.cpp", "goal_share"): REFUSED,
    ("tools/altiplan/command_line.cpp", "--patience"): REFUSED,
    ("tools/altiplan/command_line.cpp", "patience"): REFUSED,
    ("framework/host/result/stored_shape.cpp", '"stands"'): STORED,
    ("framework/host/result/stored_shape.cpp", ".stands"): STORED,
    ("framework/study/model/run_values.cpp", '"stands"'): STORED,
}
STRING = re.compile(r'"(?:[^"\\\n]|\\.)*"')


def texts(root):
    """(file, line number, text): pages and configurations by line, of code the strings."""
    for pattern in ("*.md", "docs/**/*.md", "plugins/**/*.md", "configs/**/*.yaml",
                    "tools/viewer/*.md"):
        for file in sorted(root.glob(pattern)):
            if file.name != "CHANGELOG.md":  # it names what was renamed
                for number, line in enumerate(file.read_text().split("\n"), 1):
                    yield file, number, line
    for folder in ("framework", "plugins", "tools"):
        for file in sorted((root / folder).rglob("*.[ch]pp")):
            if not file.stem.endswith("_test"):
                for number, line in enumerate(file.read_text().split("\n"), 1):
                    if not line.lstrip().startswith(("//", "#include")):
                        for string in STRING.findall(line):
                            yield file, number, string


def main():
    root = pathlib.Path(sys.argv[1])
    if "--print" in sys.argv:
        for file, number, text in texts(root):
            print(f"{file.relative_to(root)}:{number}: {text}")
        return
    former = {re.compile(pattern, re.I): better for pattern, better in FORMER.items()}
    used, found = set(), []
    for file, number, text in texts(root):
        for pattern, better in former.items():
            match = pattern.search(text)
            if not match:
                continue
            name = str(file.relative_to(root))
            if (name, match[0]) in EXCEPTIONS:
                used.add((name, match[0]))
            else:
                found.append(f"{name}:{number}: '{match[0]}': write {better}")
    found += [f"the exception {name}, '{phrase}' is not needed" for name, phrase in EXCEPTIONS
              if (name, phrase) not in used]
    if found:
        sys.exit("\n".join(found))


main()
