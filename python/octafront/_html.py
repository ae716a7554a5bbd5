"""A mesh in a notebook: a table and a histogram, and the page that shows it in 3D, as HTML that stands alone."""

import html

# A notebook keeps what it shows: the page of so many elements takes 3 MB.
_LARGEST = 300_000
# From poor to good, as the page has them: told apart by colour-blind eyes too.
_COLOURS = ["#8c2d04", "#d9650f", "#f5b26b", "#a9cce8", "#4f97d6"]


def of_mesh(mesh):
    q = mesh.quality
    rows = [
        ("tetrahedra", f"{len(mesh):,}" + (" (second order)" if mesh.order == 2 else "")),
        ("points", f"{len(mesh.points):,}"),
        ("boundary faces", f"{len(mesh.faces):,}"),
        ("β = 3 r / R", f"mean {q['beta_mean']:.3f}, least {q['beta_min']:.3f}"),
        ("dihedral angles", f"{q['dihedral_min_degrees']:.1f}° – {q['dihedral_max_degrees']:.1f}°"),
    ]
    rows += [(kind, ", ".join(names)) for kind, names in mesh.names.items() if any(names)]
    cells = "".join(f"<tr><th style='text-align:left'>{html.escape(a)}</th><td style='text-align:left'>"
                    f"{html.escape(_shown(b))}</td></tr>" for a, b in rows)
    return f"<div style='display:flex;gap:2em;align-items:center'><table>{cells}</table>{_histogram(q)}</div>{_page(mesh)}"


def _page(mesh):
    if len(mesh) > _LARGEST:
        return (f"<p>In 3D up to {_LARGEST:,} tetrahedra; this one by <code>mesh.save_page('mesh.html')</code>.</p>"
                f"<img alt='the mesh' width='600' height='450' src='data:image/png;base64,{_picture(mesh)}'>")
    import tempfile
    with tempfile.TemporaryDirectory() as folder:
        mesh.save_page(folder + "/mesh.html")
        with open(folder + "/mesh.html", encoding="utf-8") as file:
            page = html.escape(file.read())
    return (f"<iframe sandbox='allow-scripts allow-downloads allow-popups' style='width:100%;height:36em;border:0' "
            f"title='the mesh in 3D' srcdoc=\"{page}\"></iframe>")


def _picture(mesh):
    import base64
    return base64.b64encode(mesh.picture()).decode()


def _shown(text):
    """Names of groups may hold anything."""
    text = text.encode("utf-8", "replace").decode()
    return text if len(text) <= 200 else text[:200] + " …"


def _histogram(quality):
    classes, bounds = quality["beta_classes"], quality["beta_class_bounds"]
    total, bars = max(1, sum(classes)), []
    for i, count in enumerate(classes):
        height = 80 * count / total
        bars.append(f"<rect x='{10 + 40 * i}' y='{90 - height:.1f}' width='36' height='{height:.1f}' "
                    f"fill='{_COLOURS[i]}' stroke='#888'><title>{count:,}</title></rect>"
                    f"<text x='{28 + 40 * i}' y='104' font-size='9' text-anchor='middle' fill='currentColor'>"
                    f"{bounds[i]:g}–{bounds[i + 1]:g}</text>")
    return ("<svg width='220' height='110' role='img' aria-label='elements by beta'>" + "".join(bars) + "</svg>")
