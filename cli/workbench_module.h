#pragma once

// The workbench in a web page alone: what the module that its worker loads has to offer. Texts are JSON, in UTF-8, and
// stay valid until the next call. A run is a module of its own, as it is a process of its own to the server: so it can
// be ended at any time, and leaves no memory behind.
extern "C" {

/// about_workbench().
const char* octafront_workbench_about();
/// Takes a call as the server does (call_of()), for the run of this number, which writes into /made/NUMBER: {"lines":
/// how many}, or {"error": ...} where it cannot be.
const char* octafront_workbench_begin(const char* call, const char* number);
/// Runs the next of its lines: octafront_command_line(). Progress and complaints go to standard error. Returns the exit
/// status; after one other than 0 no further lines are run.
int octafront_workbench_line();
/// outcome_of() the run; `errors`: what the last line that ran said on standard error, progress apart.
const char* octafront_workbench_end(const char* errors);
}
