"""Builds the wheel (PEP 517): CMake compiles, this packs. Needs nothing but Python 3.11, CMake, and readelf or otool.

Settings, by pip's --config-settings KEY=VALUE:
    build-dir=DIR   a CMake build folder to use, made already or not; by default build/wheel
    jobs=N          compilers at the same time
    machine=NAME    of a cross build, such as aarch64; by default this one's
    cmake-args=...  more arguments of CMake, for a build folder that is new; scripts/wheel.sh has those of releases

The wheel carries the libraries that ours need, but for those that every Linux has (EVERYWHERE), beside ours, where ours
look first; and where OpenCASCADE was found octafront-cad, which reads CAD files by OpenCASCADE's libraries of the system.
It is tagged with the oldest glibc that all of them can run with, and for every Python 3: no compiled part
knows of Python. On macOS our binaries stand on nothing but the system (scripts/wheel-macos.sh has the libraries compiled in),
and the tag says for which system they were compiled (MACOSX_DEPLOYMENT_TARGET).
"""

import base64
import hashlib
import io
import pathlib
import re
import shlex
import subprocess
import sys
import tarfile
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TARGETS = ["octafront_python", "octafront_python_cli", "octafront_python_cad"]
# Parts of glibc and of GCC's run time, which no wheel carries (manylinux says the same).
EVERYWHERE = re.compile(r"(ld-linux.*|lib(c|m|dl|rt|pthread|gcc_s|stdc\+\+))\.so.*")
# A fixed time: the same sources, the same wheel.
WHEN = (2020, 1, 1, 0, 0, 0)

LAUNCHER = '''#!python
"""The command line tool that the package carries; without NumPy, and without octafront itself, which it does not need."""
import importlib.util
import os
import sys

folder = os.path.dirname(importlib.util.find_spec("octafront").origin)
os.execv(os.path.join(folder, "_bin", "octafront"), ["octafront", *sys.argv[1:]])
'''


# ---- what pip asks ----

def get_requires_for_build_wheel(config_settings=None):
    return []


def get_requires_for_build_sdist(config_settings=None):
    return []


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    settings = config_settings or {}
    build = pathlib.Path(settings.get("build-dir") or ROOT / "build" / "wheel").resolve()
    compile_in(build, settings.get("jobs"), shlex.split(settings.get("cmake-args") or ""))
    binaries, system = (collect_macos if sys.platform == "darwin" else collect)(build / "python" / "octafront" / "_bin")
    tag = f"py3-none-{system}_{settings.get('machine') or machine()}"
    name = f"octafront-{version()}-{tag}.whl"
    with Wheel(pathlib.Path(wheel_directory) / name) as wheel:
        for path in sorted((ROOT / "python" / "octafront").iterdir()):
            if path.suffix in (".py", ".pyi", ".typed"):
                wheel.add(f"octafront/{path.name}", path.read_bytes())
        for file, path in sorted(binaries.items()):
            wheel.add(f"octafront/_bin/{file}", path.read_bytes(), executable=True)
        wheel.add(f"octafront-{version()}.data/scripts/octafront", LAUNCHER.encode(), executable=True)
        for path in [*licences(binaries), build / "python" / "octafront" / "_bin" / "contents.txt"]:
            wheel.add(f"{wheel.info}/licenses/{path.name}", path.read_bytes())
        wheel.add(f"{wheel.info}/METADATA", metadata().encode())
        wheel.add(f"{wheel.info}/WHEEL", f"Wheel-Version: 1.0\nGenerator: octafront_build\nRoot-Is-Purelib: false\n"
                                         f"Tag: {tag}\n".encode())
    return name


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    folder = pathlib.Path(metadata_directory) / f"octafront-{version()}.dist-info"
    folder.mkdir()
    (folder / "METADATA").write_text(metadata())
    return folder.name


def build_sdist(sdist_directory, config_settings=None):
    """What git tracks, and PKG-INFO."""
    folder = f"octafront-{version()}"
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, stdout=subprocess.PIPE).stdout
    with tarfile.open(pathlib.Path(sdist_directory) / f"{folder}.tar.gz", "w:gz") as tar:
        for name in sorted(filter(None, listed.decode().split("\0"))):
            tar.add(ROOT / name, f"{folder}/{name}", recursive=False)
        info = tarfile.TarInfo(f"{folder}/PKG-INFO")
        info.size = len(metadata().encode())
        tar.addfile(info, io.BytesIO(metadata().encode()))
    return f"{folder}.tar.gz"


# ---- compiling ----

def compile_in(build, jobs, more):
    if not (build / "CMakeCache.txt").exists():
        run("cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DOCTAFRONT_HDF5=OFF",
            "-DOCTAFRONT_UNITY=ON", "-DOCTAFRONT_BUILD_TESTS=OFF", "-DOCTAFRONT_BUILD_EXAMPLES=OFF", *more)
    run("cmake", "--build", build, *(["-j", str(jobs)] if jobs else []), "--target", *TARGETS)


def run(*command):
    """Its output is for those who build: pip shows it with -v, and when something fails."""
    try:
        subprocess.run([str(word) for word in command], check=True, stdout=sys.stderr)
    except FileNotFoundError:
        raise SystemExit(f"{command[0]} is not installed; octafront needs: apt-get install g++ cmake ninja-build "
                         "libtbb-dev zlib1g-dev libfmt-dev libcli11-dev nlohmann-json3-dev") from None


def version():
    return re.search(r"project\(octafront VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)


def machine():
    return subprocess.run(["uname", "-m"], check=True, capture_output=True, text=True).stdout.strip()


# ---- what the binaries need ----

def collect(folder):
    """{name: file} of our binaries and all libraries that they need but for those that are everywhere; the system of the tag."""
    found = {name: folder / name for name in ("liboctafront.so", "octafront")}
    waiting = list(found.values())
    while waiting:
        file = waiting.pop()
        needed = re.findall(r"\(NEEDED\).*\[(.+)\]", output("readelf", "--wide", "--dynamic", file))
        # Then nobody has to find what a cross build needs.
        if all(EVERYWHERE.fullmatch(name) or name in found for name in needed):
            continue
        for line in output("ldd", file).splitlines():
            match = re.match(r"\s*(\S+) => (\S+)", line)
            if not match or EVERYWHERE.fullmatch(match[1]) or match[1] in found:
                continue
            if match[2] == "not":
                raise SystemExit(f"{match[1]} is needed and not found")
            found[match[1]] = pathlib.Path(match[2]).resolve()
            waiting.append(found[match[1]])
    if (folder / "octafront-cad").exists():
        found["octafront-cad"] = folder / "octafront-cad"
    return found, "manylinux_{}_{}".format(*glibc_of(found.values()))


def collect_macos(folder):
    """The same, where nothing of others may be needed."""
    found = {name: folder / name for name in ("liboctafront.so", "octafront")}
    systems = set()
    for file in found.values():
        for needed in re.findall(r"^\t(\S+) \(", output("otool", "-L", file), re.M):
            if not needed.startswith(("/usr/lib/", "/System/", "@rpath/liboctafront.so")):
                raise SystemExit(f"{file.name} needs {needed}, which other machines have not")
        systems.update(re.findall(r"^ *minos (\d+)\.(\d+)", output("otool", "-l", file), re.M))
    # Installers know systems by their first number.
    if len(systems) != 1 or (system := systems.pop())[1] != "0":
        raise SystemExit(f"compiled for {sorted(systems)}: set MACOSX_DEPLOYMENT_TARGET to one system, such as 14.0")
    return found, f"macosx_{system[0]}_0"


def glibc_of(files):
    """The newest version of glibc that a symbol asks for: (2, 36)."""
    versions = set()
    for file in files:
        versions.update(re.findall(r"GLIBC_(\d+)\.(\d+)", output("readelf", "--version-info", "--wide", file)))
    return max((int(a), int(b)) for a, b in versions)


def output(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


def licences(binaries):
    """Our licence, and those of all that is inside; contents.txt lists them, with versions."""
    texts = sorted((ROOT / "licenses").iterdir())
    for library in binaries:
        stem = re.match(r"(?:lib)?([a-z0-9-]+?)(?:\.so.*)?$", library)[1]
        if stem not in ("octafront", "octafront-cad") and not any(text.stem == stem for text in texts):
            raise SystemExit(f"the wheel would carry {library}, and licenses/{stem}.txt is missing")
    return [ROOT / "LICENSE", ROOT / "NOTICE", *texts]


# ---- packing ----

def metadata():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version()}",
             f"Summary: {project['description']}", f"License: {project['license']['text']}",
             f"Requires-Python: {project['requires-python']}", f"Keywords: {','.join(project['keywords'])}"]
    lines += [f"Classifier: {c}" for c in project["classifiers"]]
    lines += [f"Requires-Dist: {d}" for d in project["dependencies"]]
    for extra, needs in project["optional-dependencies"].items():
        lines += [f"Provides-Extra: {extra}", *(f'Requires-Dist: {d}; extra == "{extra}"' for d in needs)]
    lines += ["Description-Content-Type: text/markdown", "", (ROOT / project["readme"]).read_text()]
    return "\n".join(lines)


class Wheel:
    """A zip file with RECORD, the list of what is in it."""

    def __init__(self, path):
        self.info, self._records = f"octafront-{version()}.dist-info", []
        self._zip = zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED)

    def __enter__(self):
        return self

    def add(self, name, data, executable=False):
        entry = zipfile.ZipInfo(name, WHEN)
        entry.compress_type = zipfile.ZIP_DEFLATED
        entry.external_attr = (0o100755 if executable else 0o100644) << 16
        self._zip.writestr(entry, data)
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        self._records.append(f"{name},sha256={digest},{len(data)}")

    def __exit__(self, kind, *_):
        if kind is None:
            record = f"{self.info}/RECORD"
            self._zip.writestr(zipfile.ZipInfo(record, WHEN), "\n".join([*self._records, f"{record},,"]) + "\n")
        self._zip.close()
