"""For the Python reference: what griffe does not take for descriptions."""

import griffe


class Comments(griffe.Extension):
    def on_attribute_instance(self, *, attr, **kwargs):
        """A comment behind an attribute, or lines of comment above it."""
        if attr.docstring is not None or attr.lineno is None:
            return
        lines = attr.filepath.read_text().splitlines()[: attr.lineno]
        _, mark, comment = lines.pop().partition("  # ")
        above = []
        while lines and lines[-1].strip().startswith("# "):
            above.insert(0, lines.pop().strip()[2:])
        if mark or above:
            attr.docstring = griffe.Docstring(comment or " ".join(above), parent=attr)

    def on_class(self, *, cls, **kwargs):
        """The ways to make an object, each with its arguments."""
        ways = cls.overloads.get("__init__")
        if ways and cls.docstring:
            for way in ways:
                given = [p.name + ("" if p.required else "=...") for p in way.parameters if p.name != "self"]
                cls.docstring.value += f"\n\n`{cls.name}({', '.join(given)})`: {way.docstring.value}"
