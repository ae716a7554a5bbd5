#pragma once

#include "cad/model/stream.h"

#include <Message_ProgressRange.hxx>
#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

namespace octafront::cad {

/// Puts standard output aside for frames, before any other code can print to it; what OpenCASCADE prints goes nowhere.
void take_standard_output();

/// What OpenCASCADE complained of since, in its words: failures only, at most a few.
std::vector<std::string> heard();

/// Ends the process when the one that started it is gone. Once in each process: children of ours too.
void end_with_parent();

/// Limits of this process: bytes of address space, seconds of CPU from its start; 0: none.
void limit_memory(double bytes);
void limit_cpu(double seconds);
void lift_cpu_limit();

/// A whole frame, at once. Ends the process if nobody reads.
void send(FrameKind kind, const std::string& content);
void send_note(const std::string& sentence);
void send_error(const std::string& sentence);
void send_progress(const Where& where);
void send_progress(const std::string& stage, const std::string& what, double done = 0);
void send_progress(const std::string& stage, const std::string& what, double done, const TopoDS_Shape& place);

/// For algorithms of OpenCASCADE that tell how far they are: frames of this stage, at each hundredth.
Message_ProgressRange progress_of(const std::string& stage, const std::string& what);

}  // namespace octafront::cad
