#pragma once

// Everything that users of the library include.

#include <octafront/adapt.h>
#include <octafront/cad.h>
#include <octafront/complex.h>
#include <octafront/domain.h>
#include <octafront/error.h>
#include <octafront/field_files.h>
#include <octafront/formula.h>
#include <octafront/generate.h>
#include <octafront/ids.h>
#include <octafront/image.h>
#include <octafront/image_surface.h>
#include <octafront/improve_existing.h>
#include <octafront/io.h>
#include <octafront/mend.h>
#include <octafront/mesh_field.h>
#include <octafront/metric.h>
#include <octafront/named_groups.h>
#include <octafront/open_cavity_error.h>
#include <octafront/option_table.h>
#include <octafront/options.h>
#include <octafront/quality.h>
#include <octafront/ranks.h>
#include <octafront/repair.h>
#include <octafront/report.h>
#include <octafront/report_page.h>
#include <octafront/run_context.h>
#include <octafront/second_order.h>
#include <octafront/share_files.h>
#include <octafront/size_field.h>
#include <octafront/solver_checks.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>
#include <octafront/units.h>
#include <octafront/validity.h>
