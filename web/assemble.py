"""Puts the npm package together: assemble.py BUILT_FOLDER OUT_FOLDER

BUILT_FOLDER has octafront-module.js and .wasm, which CMake made, OUT_FOLDER octafront.html, which web/ui/assemble.py made. In
OUT_FOLDER: package/, octafront-VERSION.tgz as `npm pack` makes it. Prints sizes."""

import gzip
import io
import json
import pathlib
import shutil
import sys
import tarfile

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parent


def text(path):
    return path.read_text(encoding="utf-8")


def tarball(folder, target):
    """As npm packs: all beneath package/; the same bytes for the same files."""
    raw = io.BytesIO()
    with tarfile.open(fileobj=raw, mode="w", format=tarfile.USTAR_FORMAT) as archive:
        for path in sorted(p for p in folder.rglob("*") if p.is_file()):
            info = tarfile.TarInfo("package/" + path.relative_to(folder).as_posix())
            info.size, info.mode, info.mtime = path.stat().st_size, 0o644, 499162500
            archive.addfile(info, io.BytesIO(path.read_bytes()))
    target.write_bytes(gzip.compress(raw.getvalue(), 9, mtime=0))


def main(built, out):
    module = (built / "octafront-module.wasm").read_bytes()
    worker = text(built / "octafront-module.js") + "\n" + text(HERE / "port.js")
    package = out / "package"
    shutil.rmtree(package, ignore_errors=True)
    package.mkdir(parents=True)
    described = json.loads(text(HERE / "package.json"))
    for name in ("package.json", "octafront.js", "engine.js", "octafront.d.ts", "README.md"):
        shutil.copy(HERE / name, package / name)
    for name in ("LICENSE", "NOTICE"):
        shutil.copy(SOURCE / name, package / name)
    (package / "licenses").mkdir()
    for name in ("fmt.txt", "nlohmann_json.txt", "z.txt", "emscripten.txt", "cli11.txt", "three.txt"):
        shutil.copy(SOURCE / "licenses" / name, package / "licenses" / name)
    (package / "octafront-worker.js").write_text(worker, encoding="utf-8")
    (package / "octafront.wasm").write_bytes(module)
    shutil.copy(out / "octafront.html", package)
    missing = [name for name in described["files"] if not (package / name).exists()]
    assert not missing, f"package.json lists what there is not: {missing}"
    archive = out / f"octafront-{described['version']}.tgz"
    tarball(package, archive)
    for path in (package / "octafront.wasm", package / "octafront-worker.js"):
        data = path.read_bytes()
        print(f"{path.name}: {len(data) / 1e6:.2f} MB, {len(gzip.compress(data, 9)) / 1e6:.2f} MB gzip")
    print(f"{archive.name}: {archive.stat().st_size / 1e6:.2f} MB")


main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
