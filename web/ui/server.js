// --- server.js: the engine behind `octafront ui`. All addresses are below that of the page, which has the token.

const engine = {
  takes: "STEP, STL, OBJ, NIfTI, a mesh …",
  where: "on this machine: nothing leaves it.",
  samples: [],

  async about() {
    return (await asked("about")).json();
  },
  async upload(file) {
    return (await asked("upload/" + encodeURIComponent(file.name), { method: "PUT", body: file })).json();
  },
  async run(tool, given, { signal, progress = () => {} } = {}) {
    const response = await asked("run", { method: "POST", body: JSON.stringify({ tool, arguments: given }), signal });
    const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
    let rest = "", done = null;
    for (let part = await reader.read(); !part.done; part = await reader.read()) {
      const lines = (rest + part.value).split("\n");
      rest = lines.pop();
      for (const line of lines.filter(Boolean).map((text) => JSON.parse(text))) {
        if (line.done) done = line.done;
        else progress(line.stage, line.fraction < 0 ? null : line.fraction);
      }
    }
    if (!done) throw new RunError({ code: "lost", message: "the program is gone: it ends with its page, or by Ctrl-C" });
    if (done.error) throw new RunError(done.error, done);
    return done;
  },
  async made(run, name, { signal } = {}) {
    return asked(`made/${run}/${name.split("/").map(encodeURIComponent).join("/")}`, { signal });
  },
  async stay(gone) {
    try {
      const reader = (await asked("alive")).body.getReader();
      while (!(await reader.read()).done);
    } catch {}
    gone();
  },
};

async function asked(path, how = {}) {
  let response;
  try {
    response = await fetch(path, how);
  } catch (error) {
    if (how.signal?.aborted) throw error;
    throw new RunError({ code: "lost", message: "the program does not answer: it ends with its page, or by Ctrl-C" });
  }
  if (response.ok) return response;
  const answer = await response.json().catch(() => ({}));
  throw new RunError(answer.error ?? { code: "http", message: `the program answered ${response.status}` }, answer);
}
