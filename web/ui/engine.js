// --- engine.js: what the page asks for, whoever does it: `octafront ui` (server.js), or a module in the page (module.js). Each
// has an `engine`:
//
//   takes, where          in words: which files it takes, and where it works
//   samples               [{title, file()}], file() a promise of a File
//   about()               about_workbench() of cli/workbench_calls.h
//   upload(file)          brings a File to the program: {name, path, bytes}
//   run(tool, given, {signal, progress})
//                         runs a tool of call_of(); progress(stage, fraction) hears how far it is, fraction null where that is not
//                         known. Leaves outcome_of(). Ends when `signal` does. Throws RunError.
//   made(run, name, {signal})   a Response with a file that a run has left
//   stay(gone)            the program goes on as long as this is heard; gone() once it is not

/** What went wrong, in words; `report` is that of the run, if there is one. */
class RunError extends Error {
  constructor(error, answer = {}) {
    super(error.message);
    Object.assign(this, { code: error.code, kind: error.kind, next: answer.next ?? [], report: answer.reports?.[0] });
  }
}
