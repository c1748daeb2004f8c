# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Write the property tables of reference.md from the class headers.

    PYTHONPATH=<prefix>/lib/python3/dist-packages python3 Documentation/reference_tables.py

A row has the name of a property, its default in the wrapped class, and the first sentences of the
documentation of its Set method in the header, up to 28 words, with all values. Properties that are the
same as in an earlier class, or deprecated, are listed below the table. All this lies between the lines
`<!-- properties of CLASS -->` and `<!-- end -->`.

Testing/Python/test_reference.py fails if a table is not up to date.
"""

import math
import os
import re

import volumic

FOLDER = os.path.dirname(os.path.abspath(__file__))
PAGE = os.path.join(FOLDER, "reference.md")
TABLE = re.compile(r"(<!-- properties of (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)
COMMENT = re.compile(r"/\*\*((?:(?!\*/).)*)\*/\s*(?:void Set|\w+Macro\()(\w+)", re.DOTALL)
WORDS = 28
# Sentences that stay in a long documentation: on a value, and on requirements.
KEPT = re.compile(r"(`\w+` \(|-?\d+[:,]|Off:|Automatic:|Requires )")
CONSTANTS = ((math.nan, "none"), (math.inf, "infinite"), (math.sqrt(3), "sqrt(3)"))


def property_names(algorithm):
    """Return the properties of the filter's own class that are a number, a switch or a text."""
    names = []
    for name in (name[3:] for name in vars(type(algorithm)) if name.startswith("Set")):
        try:
            value = getattr(algorithm, "Get" + name, lambda: None)()
        except TypeError:  # a property with several values, such as LabelName
            continue
        if isinstance(value, (int, float, str)):
            names.append(name)
    return names


def read_header(class_name):
    """Return the text of a header."""
    with open(os.path.join(FOLDER, "..", "Filters", class_name + ".h"), encoding="utf-8") as file:
        return file.read()


def default_text(value):
    """Return the text of a default value in a table."""
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, str):
        return value or "empty"
    for constant, text in CONSTANTS:
        if value == constant or (math.isnan(value) and math.isnan(constant)):
            return text
    return f"{value:g}"


def meaning(kind, text):
    """Return what a table has of the text of a comment: one line, without the default."""
    text = re.sub(r"\n *\* ?", "\n", text)
    text = re.sub(r"(\n- [^\n]*(?:\n  [^\n]*)*)\n+(?=[^\s-])", r"\1. ", text)  # end of a list
    text = " ".join(text.replace("\n- ", "; ").split()).replace(".;", ".")
    text = re.sub(r"^Set/Get (the )?(.)", lambda match: match[2].upper(), text)
    text = re.sub(r" ?\(default: (?:[^()]|\([^()]*\))*\)", "", text)
    text = re.sub(r"\(default (?=[^()]+: )", "(", text)
    values = {key: value for key, value in vars(kind).items()
              if isinstance(value, int) and key[0].isupper()}
    if values:
        # An enumerator that begins a phrase gets its number.
        text = re.sub(rf"([.;:] )({'|'.join(values)})(?=[:;,])",
                      lambda match: f"{match[1]}`{match[2]}` ({int(values[match[2]])})", text)
    kept, count = [], 0
    for sentence in re.split(r"(?<=\.) (?=[A-Z0-9`-])", text.rstrip(".") + "."):
        count += len(sentence.split())
        if not kept or count <= WORDS or KEPT.match(sentence):
            kept.append(sentence)
    return " ".join(kept).replace("|", "\\|")


def default_of(class_name, name):
    """Return the text of the default of a property; None if the class does not have it."""
    get = getattr(getattr(volumic, class_name)(), "Get" + name, None)
    return default_text(get()) if get else None


def table(class_name):
    """Return the lines of the table of a class, and of the lists of properties below it."""
    kind = getattr(volumic, class_name)
    names = property_names(kind())
    rows, lists = ["| property | default | meaning |", "|---|---|---|"], {}
    for text, name in COMMENT.findall(read_header(class_name)):
        if name not in names:
            continue
        names.remove(name)
        default, text = default_of(class_name, name), meaning(kind, text)
        like = re.search(r"as in (vtkDeformableSurface)", text)
        if text.startswith("Deprecated"):
            lists.setdefault("Deprecated, without effect", []).append(name)
        elif class_name != "vtkImagePyramid" and default == default_of("vtkImagePyramid", name):
            lists.setdefault("As in `vtkImagePyramid`", []).append(name)
        elif like and len(text.split()) < 15 and default == default_of(like[1], name):
            lists.setdefault(f"As in `{like[1]}`", []).append(name)
        else:
            rows.append(f"| `{name}` | {default} | {text} |")
    if names:
        raise ValueError(f"{class_name}.h has no comment on {', '.join(names)}")
    lines = [f"{title}: {', '.join(f'`{name}`' for name in names)}.\n"
             for title, names in sorted(lists.items())]
    return "\n".join((rows + [""] if len(rows) > 2 else []) + lines)


def updated(page):
    """Return the text of the page with new tables."""
    return TABLE.sub(lambda match: match[1] + table(match[2]) + match[3], page)


if __name__ == "__main__":
    with open(PAGE, encoding="utf-8") as file:
        old = file.read()
    with open(PAGE, "w", encoding="utf-8") as file:
        file.write(updated(old))
