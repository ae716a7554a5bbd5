"""Puts the page of the workbench together: assemble.py NODE_MODULES OUT_FOLDER [BUILT_FOLDER]

NODE_MODULES has what web/ui/package.json asks for. Writes octafront-ui.html, the page of `octafront ui`; with BUILT_FOLDER, which
has octafront-workbench.js and .wasm that CMake made, octafront.html instead, which carries them and needs no server. Prints its
size. The scripts are one: those of the report page that say what a mesh is, those of this folder, and what of three.js they use,
bundled by esbuild."""

import base64
import gzip
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
ASSETS = SOURCE / "src/report/page/assets"
SHARED = [ASSETS / f"{name}.js" for name in ("decode", "colours", "camera", "curved", "surface", "panels")]
OWN = ("job", "stage", "page")
SAMPLES = {"bracket": "bracket.stl", "gear": "gear.obj", "head (labels)": "head_labels.nii.gz"}
# What a page may do: ask the server that it came from, or nobody.
OF_SERVER = "script-src 'unsafe-inline'; connect-src 'self'"
ALONE = "script-src 'unsafe-inline' 'wasm-unsafe-eval'; worker-src blob:"


def text(path):
    return path.read_text(encoding="utf-8")


def packed(name, data, **attributes):
    """An element that `unpacked()` of module.js reads."""
    more = "".join(f' data-{key}="{value}"' for key, value in attributes.items())
    return f'<script type="text/plain" id="packed-{name}"{more}>{base64.b64encode(gzip.compress(data, 9, mtime=0)).decode()}</script>\n'


def carried(built):
    worker = text(built / "octafront-workbench.js") + "\n" + text(HERE / "worker.js")
    parts = [packed("module", (built / "octafront-workbench.wasm").read_bytes()), packed("worker", worker.encode())]
    parts += [packed(f"sample-{i}", (SOURCE / "samples" / file).read_bytes(), file=file, title=title) for i, (title, file) in enumerate(SAMPLES.items())]
    return "".join(parts)


def bundled(scripts, modules, out):
    source = out / "workbench.js"
    source.write_text("\n".join(text(script).replace("\nexport ", "\n") for script in scripts), encoding="utf-8")
    made = subprocess.run([modules / ".bin/esbuild", source, "--bundle", "--minify", "--format=iife", "--charset=utf8", "--legal-comments=inline", "--target=es2022"],
                          env={"NODE_PATH": str(modules), "PATH": "/usr/local/bin:/usr/bin:/bin"}, check=True, capture_output=True)
    source.unlink()
    return made.stdout.decode().replace("</script", "<\\/script")


def main(modules, out, built=None):
    out.mkdir(parents=True, exist_ok=True)
    engine = [HERE / "server.js"] if built is None else [HERE.parent / "engine.js", HERE / "module.js"]
    script = bundled([*SHARED, HERE / "zip.js", HERE / "surface_file.js", HERE / "engine.js", *engine, *(HERE / f"{name}.js" for name in OWN)], modules, out)
    head = text(HERE / "page.html").replace("/* page.css */", text(HERE / "page.css")).replace("/* scripts */", OF_SERVER if built is None else ALONE)
    page = f"{head}{carried(built) if built else ''}<script>\n{script}</script>\n</body>\n</html>\n"
    target = out / ("octafront-ui.html" if built is None else "octafront.html")
    target.write_text(page, encoding="utf-8")
    print(f"{target.name}: {len(page.encode()) / 1e3:.0f} kB, {len(gzip.compress(page.encode(), 9)) / 1e3:.0f} kB gzip")


main(*(pathlib.Path(argument).resolve() for argument in sys.argv[1:]))
