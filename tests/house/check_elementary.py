#!/usr/bin/env python3
"""No source calls an elementary function of the C library, whose last bit differs from processor to processor: a mesh must not hang on it.
base/core/elementary.h has its own. Pictures and words for people may.

    check_elementary.py ROOT | --self-test
"""
import pathlib
import re
import sys

NAMES = ("pow|exp|exp2|exp10|expm1|log|log2|log10|log1p|cbrt|sin|cos|tan|asin|acos|atan|atan2|hypot|sinh|cosh|tanh|asinh|acosh|atanh|erf|erfc|tgamma|"
         "lgamma")
CALL = re.compile(rf"(?<![\w:.>])(?:std::|::)(?:{NAMES})[fl]?\(|(?<![\w:.>])(?:{NAMES})[fl]\(")
FOR_PEOPLE = ("src/report/",)


def calls(name, text):
    """Sentences for the calls in one source."""
    if name.startswith(FOR_PEOPLE):
        return
    for number, line in enumerate(text.splitlines(), 1):
        code = line.split("//")[0]
        for found in CALL.finditer(code):
            yield f"{name}:{number}: {found.group(0)[:-1]} differs between processors: take that of base/core/elementary.h"


def self_test():
    assert list(calls("src/a/b/c.cpp", "x = std::cos(y);"))
    assert list(calls("src/a/b/c.cpp", "x = ::hypot(y, z) + 1;"))
    assert not list(calls("src/a/b/c.cpp", "x = elementary::cos(y) + std::sqrt(z);  // not std::cos(y)"))
    assert not list(calls("src/report/page/c.cpp", "x = std::log2(y);"))


def main():
    if sys.argv[1] == "--self-test":
        return self_test()
    root = pathlib.Path(sys.argv[1])
    sources = sorted(p for folder in ("src", "include") for p in (root / folder).rglob("*") if p.suffix in (".h", ".cpp"))
    found = [sentence for p in sources for sentence in calls(p.relative_to(root).as_posix(), p.read_text())]
    print("\n".join(found))
    sys.exit(1 if found else 0)


main()
