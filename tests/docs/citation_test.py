# SPDX-License-Identifier: Apache-2.0
"""citation_test.py SOURCE VERSION: CITATION.cff is valid, has the fields of a citation, and names the
version and licence of the project."""
import pathlib
import sys

try:
    import yaml
except ImportError:
    print("skipped: needs python3-yaml (tools/setup ci)")
    sys.exit(77)


def main():
    source = pathlib.Path(sys.argv[1])
    citation = yaml.safe_load((source / "CITATION.cff").read_text())
    for key in ("cff-version", "message", "title", "authors", "type", "license", "abstract"):
        assert citation.get(key), f"CITATION.cff has no {key}"
    assert citation["cff-version"] == "1.2.0", citation["cff-version"]
    assert str(citation["version"]) == sys.argv[2], (citation["version"], sys.argv[2])
    assert all(set(author) & {"name", "family-names"} for author in citation["authors"])
    assert citation["license"] == "Apache-2.0"
    assert "Apache License" in (source / "LICENSE").read_text()[:200]


main()
