"""Reads YAML from outside: bounded in size and depth, plain data only, and what is wrong in one sentence an item.

One loader for all: vehicle files, calibration plans, a bag's metadata and what its topics declare.
"""

import re
from typing import get_args

import yaml
from mr_mount_controller.node_base.plain_text import readable, shortened
from mr_mount_controller.node_base.suggestion import suggestion
from pydantic import BaseModel, ValidationError

from .ordinary_file import open_ordinary

LARGEST = 1 << 20  # bytes of a text
DEEPEST = 50  # levels
LONGEST_NUMBER = 100  # characters; a number to base 60 takes time with the square of them
_LONGEST_REASON = 500  # characters
_MOST_ERRORS = 6


class YamlTextError(ValueError):
    """A text that cannot be used; the message names file, item, value and what is accepted."""


def read_text(path, what="file"):
    """Return the text of a file; an ordinary one of at most `LARGEST` bytes in UTF-8.

    Raises
    ------
    YamlTextError
        It cannot be read, is a folder, a device or a pipe, too large, or no text; `what` says what it should be.
    """
    name = f"{what} {str(path)!r}"
    try:
        with open_ordinary(path, LARGEST) as file:
            return file.read(LARGEST).decode()  # no more: some files of the system do not tell their size
    except (OSError, UnicodeDecodeError) as error:
        raise YamlTextError(f"{name} cannot be read: {getattr(error, 'strerror', None) or error}") from None


def load(text, name):
    """Return what a YAML text holds, as it stands.

    Raises
    ------
    YamlTextError
        It is not YAML, too large or too deep, or has aliases, of which a small text can make a huge one.
    """
    return _bounded(text, name, lambda: yaml.load(text, _Loader))  # noqa: S506, a safe one


def compose(text, name):
    """Return the root node of a YAML text, which tells where everything stands; raises as `load` does."""
    return _bounded(text, name, lambda: yaml.compose(text, _Loader))


def validated(model, text, name, kinds=None):
    """Return what a YAML text describes, by a pydantic model; raises as `load` does, and where an item does not fit.

    Where a section is of one of several kinds, pydantic puts the kind's word among the names that lead to an item;
    `kinds` says at which place of those that begin with a section.
    """
    try:
        return model.model_validate(load(text, name))
    except ValidationError as error:
        errors = error.errors(include_url=False, include_context=False)
    more = [f"{name}: and {len(errors) - _MOST_ERRORS} more items"] if len(errors) > _MOST_ERRORS else []
    sentences = [_sentence(name, each, kinds or {}, model) for each in errors[:_MOST_ERRORS]]
    raise YamlTextError("\n".join(map(readable, sentences + more)))


def _bounded(text, name, read):
    if len(text) > LARGEST:
        raise YamlTextError(readable(f"{name}: has {len(text)} characters, accepted: {LARGEST}"))
    try:
        _check_events(text)
        return read()
    # all but the first from tagged values that PyYAML does not check: impossible dates, `!!bool x`, `!!int ''`
    except (yaml.YAMLError, ValueError, LookupError, AttributeError, OverflowError, TypeError) as error:
        reason = shortened(" ".join(str(error).split()), _LONGEST_REASON)
        if not isinstance(error, yaml.YAMLError):
            reason = f"a value has the wrong type: {reason}"
        raise YamlTextError(readable(f"{name}: not a YAML file: {reason}")) from None


def _sentence(name, error, kinds, model):
    loc = error["loc"]
    places = [str(part) for place, part in enumerate(loc) if place != kinds.get(loc[0])]
    item, value = shortened(".".join(places)), shortened(repr(error["input"]))
    reason = shortened(error["msg"].removeprefix("Value error, "), _LONGEST_REASON)
    if error["type"] in ("model_type", "model_attributes_type"):
        return f"{name}: {item or 'the whole file'} is {value}: must be a section with items"
    if error["type"] == "extra_forbidden":
        accepted = _accepted(model, loc)
        meant = suggestion(str(loc[-1]), accepted)
        return f"{name}: {item} is {value}: unknown item; accepted: {', '.join(accepted)}{meant}"
    if error["type"] == "missing":
        return f"{name}: {item} is missing"
    if error["type"] == "value_error":
        return f"{name}: {item}: {reason}" if item else f"{name}: {reason}"
    return f"{name}: {item or 'the whole file'} is {value}: {reason}"


def _accepted(model, loc):
    """Return the names of all items of the section that one at `loc` stands in, of every kind that it may be of."""
    sections = [model]
    for part in loc[:-1]:  # also numbers in lists, names that a user gives, and words for kinds
        fields = [
            field for each in sections for name, field in each.model_fields.items() if part in (name, field.alias)
        ]
        sections = [found for field in fields for found in _sections(field.annotation)] or sections
    return sorted({field.alias or name for each in sections for name, field in each.model_fields.items()})


def _sections(annotation):
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [found for part in get_args(annotation) for found in _sections(part)]


def _check_events(text):
    """Raise `yaml.YAMLError` for aliases and depth, before anything is built from the text."""
    depth = 0
    for event in yaml.parse(text, yaml.CSafeLoader):
        if isinstance(event, yaml.AliasEvent):
            raise yaml.YAMLError(f"alias *{event.anchor} is not accepted, write the value out")
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
            if depth > DEEPEST:
                raise yaml.YAMLError(f"nested too deeply, accepted: {DEEPEST} levels")
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1


def _check_node(node):
    """Raise `yaml.YAMLError` for items that stand twice and long numbers, here and below."""
    if isinstance(node, yaml.MappingNode):
        before = {}
        for key, value in node.value:
            first = before.setdefault((key.tag, str(key.value)), key)
            if first is not key:
                lines = f"{first.start_mark.line + 1} and {key.start_mark.line + 1}"
                raise yaml.YAMLError(f"{shortened(str(key.value))} is given twice, in lines {lines}")
            _check_node(key)
            _check_node(value)
    elif isinstance(node, yaml.SequenceNode):
        for each in node.value:
            _check_node(each)
    elif node is not None and node.tag == "tag:yaml.org,2002:int" and len(node.value) > LONGEST_NUMBER:
        raise yaml.YAMLError(f"a number of {len(node.value)} characters, accepted: {LONGEST_NUMBER}")


class _Loader(yaml.CSafeLoader):
    """PyYAML's safe one, but without long numbers and items that stand twice."""

    def get_single_node(self):
        node = super().get_single_node()
        _check_node(node)
        return node


# YAML 1.2 and ROS 2 take 1e3 for a number, PyYAML alone for a text
_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float", re.compile(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)[eE][-+]?[0-9]+$"), list("-+.0123456789")
)
