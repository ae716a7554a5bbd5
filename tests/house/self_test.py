"""What checkers of the tree share: each is shown a small tree with one fault of each kind, and must find them all."""
import pathlib
import tempfile


def finds(checker, files, expected):
    """Whether checker(root).check() gives the expected lines of a tree of these files; prints what differs."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        found = checker(root).check()
    for line in sorted(set(expected) ^ set(found)):
        print("not found:" if line in expected else "not expected:", line)
    return sorted(found) == sorted(expected)
