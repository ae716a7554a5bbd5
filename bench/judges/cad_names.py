"""Names of a STEP file, read from its text, and which of them are groups in a mesh of it: in files of Gmsh, Abaqus and Netgen."""
import gzip
import re

STRING = r"'((?:[^']|'')*)'"
ENTITY = r"#(\d+)\s*=\s*"
TEXT = r"\s*(?:'(?:[^']|'')*'|\$)\s*,\s*"  # one that is not asked for
PRODUCT = re.compile(ENTITY + r"PRODUCT\s*\(\s*" + STRING + r"\s*,\s*" + STRING)
FORMATION = re.compile(ENTITY + r"PRODUCT_DEFINITION_FORMATION\w*\s*\(" + TEXT + TEXT + r"#(\d+)")
DEFINITION = re.compile(ENTITY + r"PRODUCT_DEFINITION(?:_WITH_ASSOCIATED_DOCUMENTS)?\s*\(" + TEXT + TEXT + r"#(\d+)")
USAGE = re.compile(r"NEXT_ASSEMBLY_USAGE_OCCURRENCE\s*\(" + TEXT * 3 + r"#(\d+)")
KINDS = {
    "solids": re.compile(r"\b(?:MANIFOLD_SOLID_BREP|BREP_WITH_VOIDS|FACETED_BREP)\s*\(\s*" + STRING),
    "faces": re.compile(r"\b(?:ADVANCED_FACE|FACE_SURFACE)\s*\(\s*" + STRING),
}
NO_NAMES = re.compile(r"(NONE|None|Open CASCADE STEP translator.*|)$")


def decoded(text):
    """Of a string of ISO 10303-21."""
    text = re.sub(r"\\X2\\((?:[0-9A-Fa-f]{4})+)\\X0\\", lambda m: bytes.fromhex(m[1]).decode("utf-16-be", "replace"), text)
    text = re.sub(r"\\X\\([0-9A-Fa-f]{2})", lambda m: chr(int(m[1], 16)), text)
    text = re.sub(r"\\S\\(.)", lambda m: chr(ord(m[1]) + 128), text)
    return text.replace("''", "'").replace("\\\\", "\\").replace("\n", "").replace("\r", "").strip()


def is_step(file):
    return file.suffix.lower() in (".stp", ".step")


def products(text):
    """Names of products, those of assemblies apart: of products of which others are components."""
    formations = {m[1]: m[2] for m in FORMATION.finditer(text)}
    definitions = {m[1]: formations.get(m[2]) for m in DEFINITION.finditer(text)}
    assemblies = {definitions.get(m[1]) for m in USAGE.finditer(text)}
    found = {"products": set(), "assemblies": set()}
    for m in PRODUCT.finditer(text):
        found["assemblies" if m[1] in assemblies else "products"].add(decoded(m[3]) or decoded(m[2]))
    return found


def names_in_step(file):
    """{kind: names}, each name once; kinds without names are left out, and what OpenCASCADE writes where there is none."""
    if not is_step(file):
        return {}
    text = file.read_bytes()
    text = (gzip.decompress(text) if text[:2] == b"\x1f\x8b" else text).decode("utf-8", "replace")
    found = products(text) | {kind: {decoded(m[1]) for m in pattern.finditer(text)} for kind, pattern in KINDS.items()}
    named = {kind: {name for name in names if not NO_NAMES.match(name)} for kind, names in found.items()}
    return {kind: names for kind, names in named.items() if names}


def groups_in_gmsh(mesh):
    data = mesh.read_bytes()
    section = re.search(rb"\$PhysicalNames\r?\n(.*?)\$EndPhysicalNames", data, re.S)
    return set(re.findall(r'^\d+ -?\d+ "(.*)"\s*$', section[1].decode("utf-8", "replace"), re.M)) if section else set()


def groups_in_abaqus(mesh):
    """Those of sets and surfaces, and by our comments what they were before they were made legal."""
    legal, names = {}, set()
    with open(mesh, encoding="utf-8", errors="replace") as lines:
        for line in lines:
            if line[0] == "*":
                if before := re.match(r'\*\* NAME (\S+) IS "(.*)"$', line):
                    legal[before[1]] = before[2]
                if made := re.match(r"\*(?:ELEMENT|ELSET|NSET|SURFACE)\b.*(?:ELSET|NSET|NAME)\s*=\s*([^,\s]+)", line, re.I):
                    names.add(made[1])
    return {legal.get(name, name) for name in names}


def groups_in_netgen(mesh):
    text = mesh.read_text(encoding="utf-8", errors="replace")
    sections = re.findall(r"^(?:materials|bcnames)\n\d+\n((?:\d+\s+.*\n)*)", text, re.M)
    return {line.split(None, 1)[1].strip() for section in sections for line in section.splitlines() if " " in line or "\t" in line}


def arrived(names, groups):
    """{kind: [found, all]}"""
    return {kind: [len(wanted & groups), len(wanted)] for kind, wanted in names.items()}
