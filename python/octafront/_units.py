"""Lengths with a unit of their own, "2mm", as the command line takes them."""

import functools
import json
import re

from . import errors
from ._images import are_files, is_file
from ._library import call, file_of, option_table, text_of


def lengths():
    """Keywords that take them."""
    return [row["name"] for row in option_table() if row["is_length"]]


@functools.lru_cache(maxsize=None)
def _table():
    return json.loads(call("units"))


@functools.lru_cache(maxsize=None)
def _metres():
    """By the name of a unit and the words that files have for it."""
    return {word: unit["metres"] for unit in _table() for word in [unit["name"], *unit["words"].split()]}


def _names():
    return ", ".join(unit["name"] for unit in _table())


def convert_lengths(given, source):
    """Turns the lengths among the keywords `given` into numbers, in the unit of `source`: the keyword `unit`, or else what
    its file says."""
    unit = given.pop("unit", None)
    if unit is not None and str(unit).lower() not in _metres():
        raise errors.OptionError(f"`unit` is {unit!r}: it is one of {_names()}")
    for name in lengths():
        if isinstance(given.get(name), str):
            number, word = _taken_apart(name, given[name])
            if word:
                unit = unit or _unit_of(source)
                if not unit:
                    raise errors.OptionError(f"`{name}` is {given[name]!r}, but the input does not say what its coordinates "
                                             "count; add unit=\"mm\", or whatever they are, or give the length without")
                number = number * _metres()[word] / _metres()[str(unit).lower()]
            given[name] = number


def _taken_apart(name, text):
    number, word = re.fullmatch(r"\s*(.*?)\s*([A-Za-z]*)\s*", text, re.S).groups()
    word = word.lower()
    try:
        value = float(number)
    except ValueError:
        raise errors.OptionError(f"`{name}` needs a number, or a length such as \"2mm\", not {text!r}") from None
    if word and word not in _metres():
        raise errors.OptionError(f"`{name}` is {text!r}: its unit is not known; it is one of {_names()}")
    return value, word


def name_of_unit(word):
    """The short name of a unit that is known."""
    word = str(word).lower()
    return next(unit["name"] for unit in _table() if word in (unit["name"], *unit["words"].split()))


def is_cad(source):
    """Whether the source is a CAD file."""
    return is_file(source) and bool(call("is_cad", file_of(source)))


def _unit_of(source):
    file = source if is_file(source) else source[0] if are_files(source) else None
    if file is None:
        return ""
    found = call("unit_of_file", file_of(file))
    if found is None:
        raise errors.InputError(text_of(call("last_error")))
    return found.decode()
