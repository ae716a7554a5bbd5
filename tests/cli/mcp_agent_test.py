"""From a STEP part to a CalculiX deck that is solved, by a client of others that knows nothing but the tools' descriptions:
mcp_agent_test.py OCTAFRONT SAMPLES_DIR [--transcript]. Needs node, npm (@modelcontextprotocol/sdk) and ccx; skipped without.
  --transcript   prints the calls and what they were answered, as docs/use/agents.md has them
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

OCTAFRONT, SAMPLES = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
SKIPPED = 77


def skip(why):
    print(f"{why}: skipped")
    sys.exit(SKIPPED)


def brief(value, most=3):
    """An answer as a page shows it: long lists and numbers shortened."""
    if isinstance(value, dict):
        return {k: brief(v, most) for k, v in value.items() if k not in ("command_line", "hash", "notes", "outputs", "box")}
    if isinstance(value, list):
        return [brief(v, most) for v in value[:most]] + (["..."] if len(value) > most else [])
    return float(f"{value:.3g}") if isinstance(value, float) else value


def transcript(calls):
    for call in calls:
        print(f"> {call['tool']} {json.dumps(call['arguments'])}")
        answer = brief(call["answer"])
        keys = {"inspect": ("kind", "unit", "places"), "plan": ("dry_run",), "mesh": ("tets", "order", "quality"), "check": ("valid", "solver"), "explain": ("text",),
                "picture": ("picture",)}[call["tool"]]
        shown = {k: answer[k] for k in ("status", "error", "next", *keys) if k in answer}
        if "quality" in shown:
            shown["quality"] = {k: v for k, v in shown["quality"].items() if k in ("beta_min", "beta_mean")}
        if "dry_run" in shown:
            shown["dry_run"] = {k: v for k, v in shown["dry_run"].items() if k in ("expected_tets", "seconds", "memory_bytes")}
        if "error" in shown:
            shown["error"]["message"] = shown["error"]["message"][:120] + " ..."
        if "text" in shown:
            shown["text"] = shown["text"][:60] + " ..."
        print(json.dumps(shown, ensure_ascii=False) + "\n")


def main():
    for program in ("node", "npm", "ccx"):
        if shutil.which(program) is None:
            skip(f"no {program} here")
    with tempfile.TemporaryDirectory() as scratch:
        folder, work = pathlib.Path(scratch) / "parts", pathlib.Path(scratch) / "agent"
        folder.mkdir(), work.mkdir()
        shutil.copy(SAMPLES / "bracket.step", folder / "bracket.step")
        shutil.copy(pathlib.Path(__file__).parent / "mcp_agent.mjs", work)
        installed = subprocess.run(["npm", "install", "--no-audit", "--no-fund", "@modelcontextprotocol/sdk@1"], cwd=work, capture_output=True, text=True, timeout=300)
        if installed.returncode != 0:
            skip("npm has no @modelcontextprotocol/sdk")
        done = subprocess.run(["node", "mcp_agent.mjs", OCTAFRONT, folder, "bracket.step", "deck.inp"], cwd=work, capture_output=True, text=True, timeout=400)
        if done.returncode != 0 and "octafront-cad" in done.stdout:
            skip("no octafront-cad was built")
        assert done.returncode == 0, done.stderr + done.stdout
        calls = [json.loads(line) for line in done.stdout.splitlines()]
        solved = subprocess.run(["ccx", "deck"], cwd=folder, capture_output=True, text=True, timeout=300)
        assert solved.returncode == 0, solved.stdout[-2000:]
        total = [0, 0, 0]
        for force in re.findall(r"total force.*\n\n(.*)\n", (folder / "deck.dat").read_text()):
            total = [a + float(b) for a, b in zip(total, force.split())]
        assert abs(total[0] - 500) < .5 and abs(total[1]) < .5 and abs(total[2]) < .5, total
        assert sorted(p.name for p in folder.iterdir() if not p.name.startswith("deck.")) in (["bracket.step"], ["bracket.step", "spooles.out"])
        assert (folder / "deck.png").read_bytes().startswith(b"\x89PNG")
        if "--transcript" in sys.argv:
            transcript(calls)
            print(f"reactions: {total[0]:.3f}, {total[1]:.3f}, {total[2]:.3f}")


main()
