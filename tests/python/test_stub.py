"""The type stub has the names of the extension, with the same arguments and docstrings in the same order."""

import ast
import pathlib
import re

import selvedge
from selvedge import _selvedge

STUB = ast.parse((pathlib.Path(selvedge.__file__).parent / "_selvedge.pyi").read_text())


def arguments(node):
    a = node.args
    return [arg.arg for arg in a.posonlyargs + a.args + a.kwonlyargs if arg.arg != "self"]


def functions(body):
    """The functions of a part of the type stub (_selvedge.pyi), without the setters of properties."""
    return [node for node in body if isinstance(node, ast.FunctionDef) and
            not any(isinstance(mark, ast.Attribute) and mark.attr == "setter" for mark in node.decorator_list)]


def stubbed(body):
    found = {}
    for node in functions(body):
        found.setdefault(node.name, []).append(arguments(node))
    return found


def real(thing):
    # nanobind keeps a text such as "def check(x: object, triangles: object, bodies: list = ...) -> dict".
    texts = [signature[0] for signature in thing.__nb_signature__]
    inner = [re.search(r"\((.*)\)", re.sub(r"\[[^\]]*\]", "", text)).group(1) for text in texts]
    return [[name for name in re.findall(r"(?:^|, )(\w+):", text) if name != "self"] for text in inner]


def stub_docs(body):
    """Docstrings of functions and methods, one an overload, without breaks of lines."""
    found = {}
    for node in functions(body):
        found.setdefault(node.name, []).append(" ".join((ast.get_docstring(node) or "").split()))
    return found


def real_docs(thing):
    signatures = getattr(thing, "__nb_signature__", None)
    return [thing.__doc__] if signatures is None else [signature[1] for signature in signatures]


def public(thing):
    return {name for name in vars(thing) if not name.startswith("_")}


def test_functions():
    found = stubbed(STUB.body)
    assert set(found) == {name for name in public(_selvedge) if not isinstance(getattr(_selvedge, name), type)}
    for name, all_arguments in found.items():
        assert all_arguments == real(getattr(_selvedge, name)), name


def test_scene():
    scene = next(node for node in STUB.body if isinstance(node, ast.ClassDef) and node.name == "Scene")
    methods = stubbed(scene.body)
    assert {name for name in methods if not name.startswith("_")} == public(selvedge.Scene)
    for name, all_arguments in methods.items():
        member = getattr(selvedge.Scene, name)
        if hasattr(member, "__nb_signature__"):
            assert all_arguments == real(member), name


def test_docstrings():
    scene = next(node for node in STUB.body if isinstance(node, ast.ClassDef) and node.name == "Scene")
    assert ast.get_docstring(scene) == selvedge.Scene.__doc__
    for body, of in [(STUB.body, _selvedge), (scene.body, selvedge.Scene)]:
        for name, texts in stub_docs(body).items():
            assert texts == real_docs(getattr(of, name)), name


def test_everything_public_says_what_it_is():
    for name in selvedge.__all__:
        if name != "Error":
            assert getattr(selvedge, name).__doc__, name
    for name in public(selvedge.Scene):
        assert getattr(selvedge.Scene, name).__doc__, name
