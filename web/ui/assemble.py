"""Puts the page of `octafront ui` together: assemble.py NODE_MODULES OUT_FOLDER

NODE_MODULES has what web/ui/package.json asks for. Writes octafront-ui.html and prints its size. The scripts are one: those of
the report page that say what a mesh is, those of this folder, and what of three.js they use, bundled by esbuild."""

import gzip
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ASSETS = HERE.parents[1] / "src/report/page/assets"
SHARED = [ASSETS / f"{name}.js" for name in ("decode", "colours", "camera", "curved", "surface", "panels")] + [HERE.parent / "page/zip.js"]
OWN = [HERE / f"{name}.js" for name in ("surface_file", "server", "job", "stage", "page")]


def text(path):
    return path.read_text(encoding="utf-8")


def main(modules, out):
    out.mkdir(parents=True, exist_ok=True)
    source = out / "workbench.js"
    source.write_text("\n".join(map(text, SHARED + OWN)), encoding="utf-8")
    bundled = subprocess.run([modules / ".bin/esbuild", source, "--bundle", "--minify", "--format=iife", "--charset=utf8", "--legal-comments=inline", "--target=es2022"],
                             env={"NODE_PATH": str(modules), "PATH": "/usr/local/bin:/usr/bin:/bin"}, check=True, capture_output=True)
    script = bundled.stdout.decode().replace("</script", "<\\/script")
    style = text(HERE.parent / "page/page.css") + text(HERE / "page.css")
    page = f"{text(HERE / 'page.html').replace('/* page.css */', style)}<script>\n{script}</script>\n</body>\n</html>\n"
    target = out / "octafront-ui.html"
    target.write_text(page, encoding="utf-8")
    source.unlink()
    print(f"{target.name}: {len(page.encode()) / 1e3:.0f} kB, {len(gzip.compress(page.encode(), 9)) / 1e3:.0f} kB gzip")


main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve())
