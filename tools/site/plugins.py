# SPDX-License-Identifier: Apache-2.0
"""A page for each plugin, from its README and the output of `altiplan describe`."""
import json
import re
import subprocess

KINDS = ["environment", "constraint", "planner", "local_planner", "smoother", "objective", "task", "tuner"]
TRAITS = {
    "complete": "finds a route of its search space whenever there is one",
    "optimal": "and the shortest of them",
    "any_angle": "never longer than the grid's shortest",
    "anytime": "more budget never gives a longer route",
    "incremental": "its session keeps what it searched",
    "planar": "plans level flight",
    "spatial": "plans in three dimensions",
    "loiters": "plans from and to loiter circles",
    "avoids_obstacles": "no leg through a known obstacle",
    "objectives": "minimises any objective that does not depend on the time",
    "whole_routes": "minimises any objective, also of the time and of waypoints",
}


def plural(kind):
    return kind.replace("_", " ") + "s"


def asked(program, *arguments):
    return json.loads(subprocess.run([program, *arguments, "--json"], check=True, text=True,
                                     stdout=subprocess.PIPE).stdout)


def offered(program):
    """(kind, name): sentence, of the plugins in this build."""
    answer = asked(program, "plugins")
    entries = answer["built_in"] + [entry for library in answer["libraries"]
                                    for entry in library["plugins"]]
    return {(entry["kind"], entry["name"]): entry["sentence"] for entry in entries}


def promises(description):
    traits = description["traits"]
    if traits is None:
        return ""
    kept = [f"*{name.replace('_', ' ')}* ({TRAITS[name]})" for name, held in traits.items() if held]
    return ("\nWith its default parameters it guarantees: " + ", ".join(kept) + ".\n" if kept else
            "\nIt declares no guarantees that the conformance suite could check.\n")


def head(kind, name, sentence, description):
    sentence = sentence[0].upper() + sentence[1:]
    return (f"# {name}\n\n**{sentence}.**\n\n"
            f"{'An' if kind[0] == 'e' else 'A'} [{kind.replace('_', ' ')}](../../../docs/interfaces/"
            f"{kind}.md), {'built in' if description['library'] is None else 'a plugin'}; "
            f"`altiplan describe {name}` prints its parameters.\n{promises(description)}\n")


def of_readme(root, kind, name, sentence, description, problems):
    page = f"plugins/{kind}/{name}/README.md"
    text = (root / page).read_text()
    for parameter in description["parameters"]:
        if f"`{parameter['key'].split(',')[0]}" not in text:
            problems.append(f"{page}: knows no parameter {parameter['key']}: build the program anew")
    return page, re.sub(r"\A(<!--.*-->\n)?# .*\n+", lambda _: head(kind, name, sentence, description), text)


def built_in(root, kind, name, sentence, description):
    """The table is that of docs/reference/files.md or objectives.md."""
    table = re.search(f"<!-- parameters of {name} -->\n(.*?)<!-- /parameters -->",
                      "".join((root / "docs/reference" / page).read_text() for page in ("files.md", "objectives.md")),
                      re.S)[1]
    return (f"plugins/{kind}/{name}/README.md", head(kind, name, sentence, description)
            + f"## Parameters\n\n{table}\n[Files](../../../docs/reference/files.md) describes the format of layers.\n")


def listed(entries, link):
    return "".join(f"| [{name}]({link(name)}) | {sentence.replace('|', chr(92) + '|')} |\n"
                   for name, sentence in entries)


def pages(root, program, problems):
    """(page, text) of each plugin, of each kind and of the index of all."""
    here = offered(program)
    all_kinds = "# Plugins\n"
    for kind in KINDS:
        names = {name: sentence for (of, name), sentence in here.items() if of == kind}
        for name, sentence in names.items():
            found = asked(program, "describe", name)  # a list where kinds share the name
            description = next(one for one in (found if isinstance(found, list) else [found])
                               if one["kind"] == kind)
            if (root / "plugins" / kind / name).is_dir():
                yield of_readme(root, kind, name, sentence, description, problems)
            else:
                yield built_in(root, kind, name, sentence, description)
        for folder in sorted((root / "plugins" / kind).iterdir()):
            if folder.is_dir() and folder.name not in names:
                names[folder.name] = "not in the build of these pages"
                yield f"plugins/{kind}/{folder.name}/README.md", (folder / "README.md").read_text()
        heading = plural(kind).capitalize()
        entries = sorted(names.items())
        rows = "\n| plugin | |\n|---|---|\n"
        yield (f"plugins/{kind}/README.md",
               f"# {heading}\n\n[The interface](../../docs/interfaces/{kind}.md) of all of them.\n{rows}"
               + listed(entries, lambda name: f"{name}/README.md"))
        all_kinds += f"\n## [{heading}]({kind}/README.md)\n{rows}" + listed(
            entries, lambda name, kind=kind: f"{kind}/{name}/README.md")
    yield "plugins/README.md", all_kinds
