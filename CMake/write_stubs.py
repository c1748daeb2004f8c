# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Write the type stubs of the package `volumic` for editors and type checkers.

    python3 write_stubs.py OUTPUT     # `volumic` and `vtkmodules` must be on PYTHONPATH

The signatures are in the docstrings of the wrapped classes. VTK's own generator is missing in Debian's
VTK 9.1, and omits docstrings, properties and classes of other modules.

Debian's VTK has no stubs. Therefore each class also lists the methods that it inherits from VTK, such as
Update() and SetInputConnection().
"""

import ast
import inspect
import re
import sys
import textwrap
from pathlib import Path

import volumic
from volumic import vtkFiltersVolumic as module

# Type names in VTK's docstrings. Other names are classes of VTK, or else Any.
TYPES = {"int": "int", "float": "float", "bool": "bool", "str": "str", "bytes": "bytes",
         "None": "None", "Callback": "Callable[..., Any]"}
# Special methods of later versions of VTK have no signatures.
SPECIAL = {"__init__": "(self, **properties: Any) -> None",
           "__call__": "(self, *inputs: Any) -> Any",
           "__rshift__": "(self, consumer: Any) -> Any",
           "__rrshift__": "(self, producer: Any) -> Any"}
# The wrapper also accepts the name of an event, which is not in the docstring.
CORRECTIONS = {"AddObserver": ("event:int", "event:EventName")}
UNKNOWN = "(self, *arguments: Any) -> Any"

HEAD = """# Written by the build, from the classes' docstrings (CMake/write_stubs.py).
from collections.abc import Callable, MutableSequence, Sequence
from typing import Any, overload

"""


class Types:
    """Annotations, and the classes of VTK that they name."""

    def __init__(self):
        self.imports = {}  # class: VTK's module
        self.homes = {name: home for home in list(sys.modules) if home.startswith("vtkmodules.vtk")
                      for name, value in vars(sys.modules[home]).items()
                      if inspect.isclass(value) and value.__module__ == home}

    def named(self, name):
        if name == "EventName":
            return "int | str"
        if name in TYPES:
            return TYPES[name]
        if hasattr(module, name):
            return name
        if name not in self.homes:
            return "Any"
        self.imports[name] = self.homes[name]
        return name

    def of(self, node, is_result):
        """Return the annotation of a type of VTK: a name, (float, float) or [float, float]."""
        if isinstance(node, ast.Constant):  # None
            return self.named(str(node.value))
        if isinstance(node, ast.Name):
            return self.named(node.id)
        if isinstance(node, (ast.Tuple, ast.List)) and node.elts:
            parts = [self.of(part, is_result) for part in node.elts]
            if is_result and isinstance(node, ast.Tuple):
                return f"tuple[{', '.join(parts)}]"
            kind = "Sequence" if isinstance(node, ast.Tuple) else "MutableSequence"
            return f"{kind}[{parts[0]}]"
        return "Any"

    def signature(self, text):
        """Return "(name: type, ...) -> type" for the text of the wrapper; None if it is not a signature."""
        try:
            function = ast.parse(f"def {text}: ...").body[0]
        except SyntaxError:
            return None
        arguments = function.args.args
        without = len(arguments) - len(function.args.defaults)
        written = []
        for number, argument in enumerate(arguments):
            entry = argument.arg.lstrip("_") or f"argument{number}"
            if argument.annotation is not None:
                entry += f": {self.of(argument.annotation, False)}"
            if number >= without:
                entry += " = ..."
            written.append(entry)
        result = self.of(function.returns, True) if function.returns else "None"
        return f"({', '.join(written)}) -> {result}"


def signatures_and_text(name, doc):
    """Return the lines of the wrapper at the beginning of a docstring, and the rest."""
    head, _, text = (doc or "").partition("\n\n")
    lines = re.sub(r"\n[ \t]+", " ", head).splitlines()
    signatures = [line for line in lines if line.startswith(f"{name}(")]
    if not signatures:
        return [], (doc or "").strip()
    if name in CORRECTIONS:
        signatures = [line.replace(*CORRECTIONS[name]) for line in signatures]
    return signatures, text.strip()


def group_text(owner, name):
    """Return the docstring of Set..., for Get..., ...On and others without one."""
    stem = re.sub(r"^(Get|Set)|(On|Off)$", "", name)
    for group in (stem, re.sub(r"(MinValue|MaxValue|To[A-Z]\w*)$", "", stem)):
        setter = vars(owner).get(f"Set{group}")
        text = signatures_and_text(setter.__name__, setter.__doc__)[1] if setter else ""
        if text:
            return text
    return ""


def indented(text):
    return textwrap.indent(text, "    ")


def quoted(text):
    """Return a docstring, or ... if there is no text."""
    if not text:
        return "..."
    text = text.replace("\\", "\\\\").replace('"""', '\\"""')
    return f'"""{text}"""' if "\n" not in text and not text.endswith('"') else f'"""{text}\n"""'


def function(signature, text="", decorators=()):
    lines = [f"@{decorator}" for decorator in decorators]
    body = quoted(text)
    lines.append(f"def {signature}:" + (" ..." if body == "..." else f"\n{indented(body)}"))
    return "\n".join(lines)


def method(types, owner, name, value):
    texts, text = signatures_and_text(name, value.__doc__)
    signatures = []
    for signature in map(types.signature, texts):
        if signature and signature not in signatures:
            signatures.append(signature)
    text = text or group_text(owner, name)
    if not signatures:
        kinds = ["classmethod"] if "classmethod" in type(value).__name__ else []
        return function(name + UNKNOWN, text, kinds)
    written = []
    for signature in signatures:
        decorators = ["overload"] if len(signatures) > 1 else []
        if not re.match(r"\(self\b", signature):
            decorators.append("staticmethod")
        written.append(function(name + signature, "" if written else text, decorators))
    return "\n".join(written)


def property_of(types, owner, name, value):
    """Return the stub of a property of VTK 9.4 and later, whose docstring names its methods."""
    match = re.match(r"(read-only|write-only|read-write), calls (\w+)", value.__doc__ or "")
    access, called = match.groups() if match else ("read-write", "")
    callee = vars(owner).get(called)
    texts, text = signatures_and_text(called, callee.__doc__ if callee else "")
    results = [s for s in map(types.signature, texts) if s and s.startswith("(self) -> ")]
    result = results[0].partition(" -> ")[2] if results else "Any"
    text = text or group_text(owner, called)
    written = function(f"{name}(self) -> {result}", text, ["property"])
    if access != "read-only":
        accepted = result if result in TYPES.values() else "Any"
        setter = f"{name}(self, value: {accepted}) -> None"
        written += "\n" + function(setter, decorators=[f"{name}.setter"])
    return written


def members(cls):
    """Yield (owner, name, value) of members of the class and of its base classes in VTK."""
    seen = set()
    for owner in cls.__mro__:
        if owner is object or (owner is not cls and owner.__module__ == module.__name__):
            return
        for name, value in vars(owner).items():
            if name not in seen and (not name.startswith("_") or name in SPECIAL):
                seen.add(name)
                yield owner, name, value


def class_stub(types, cls):
    enumerations, constants, methods = [], [], []
    for owner, name, value in members(cls):
        if inspect.isclass(value):
            enumerations.append(f"class {name}({types.named(value.__base__.__name__)}): ...")
        elif name in SPECIAL:
            methods.append(function(name + SPECIAL[name]))
        elif inspect.isgetsetdescriptor(value):
            methods.append(property_of(types, owner, name, value))
        elif inspect.isroutine(value):
            methods.append(method(types, owner, name, value))
        else:
            constants.append(f"{name}: {type(value).__name__}")
    body = "\n".join([quoted(inspect.getdoc(cls)), *enumerations, *constants, *methods])
    return f"class {cls.__name__}({types.named(cls.__base__.__name__)}):\n{indented(body)}\n"


def classes():
    """Return the classes of the module, each after its base class."""
    found = [value for value in vars(module).values() if inspect.isclass(value)]
    return sorted(found, key=lambda cls: (len(cls.__mro__), cls.__name__))


def module_stub():
    types = Types()
    written = [class_stub(types, cls) for cls in classes()]
    homes = sorted(set(types.imports.values()))
    imports = "".join(
        f"from {home} import (\n"
        + "".join(f"    {name},\n" for name in sorted(types.imports) if types.imports[name] == home)
        + ")\n" for home in homes)
    return HEAD + imports + "\n" + "\n".join(written)


def package_stub():
    names = "".join(f"    {cls.__name__} as {cls.__name__},\n" for cls in classes())
    return (f"{quoted(volumic.__doc__.strip())}\n"
            "from .arrays import labels as labels, surface as surface\n"
            "from .reading import read as read\n"
            f"from .vtkFiltersVolumic import (\n{names})\n\n__version__: str\n")


def main():
    output = Path(sys.argv[1])
    for name, text in (("vtkFiltersVolumic.pyi", module_stub()), ("__init__.pyi", package_stub()),
                       ("py.typed", "")):
        (output / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
