#pragma once

#include "session.h"

namespace octafront::cli {

/// The commands. What goes wrong is thrown as an octafront::Error.
void run_mesh(Session& session);
void run_surface(Session& session);
void run_repair(Session& session);
void run_size(Session& session);
void run_improve(Session& session);
void run_adapt(Session& session);
void run_carry(Session& session);
void run_move(Session& session);
void run_check(Session& session);
void run_report(Session& session);
void run_picture(Session& session);
void run_info(Session& session);
void run_convert(Session& session);

}  // namespace octafront::cli
