#include <octafront/error.h>
#include <octafront/units.h>

#include "formats/write/foam_files.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

namespace octafront::io {

namespace {

namespace fs = std::filesystem;

/// Of the flow that comes in: turbulence of 1 %, and an eddy viscosity of ten times the fluid's.
constexpr double kIntensity = 0.01, kViscosityRatio = 10;
constexpr int kIterations = 500;

enum class Role { kInlet, kOutlet, kSlip, kSymmetry, kRoad, kWall };

Role role_of(std::string_view name) {
  const auto is = [&](std::string_view word) { return name == word || name == "tunnel_" + std::string(word); };
  const auto starts = [&](std::string_view word) { return name.starts_with(word); };
  if (starts("inlet") || is("inlet")) return Role::kInlet;
  if (starts("outlet") || is("outlet")) return Role::kOutlet;
  if (starts("symmetry")) return Role::kSymmetry;
  if (is("side_left") || is("side_right") || is("top")) return Role::kSlip;
  return is("ground") ? Role::kRoad : Role::kWall;
}

struct FoamPatch {
  std::string name;
  Role role;
  Vec3 lo{HUGE_VAL, HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  double shadow = 0;  ///< half of its area as seen along x
};

FoamPatch patch_of(const MeshParts& mesh, const Part& part, const std::string& name) {
  FoamPatch patch{name, role_of(name)};
  for (const std::uint32_t f : part.members) {
    const auto& [a, b, c] = mesh.face(f);
    const std::vector<Vec3>& p = mesh.mesh().points;
    patch.shadow += 0.25 * std::abs(cross(p[b] - p[a], p[c] - p[a]).x);
    for (const VertexIndex v : mesh.face(f))
      for (int axis = 0; axis < 3; ++axis)
        patch.lo[axis] = std::min(patch.lo[axis], p[v][axis]), patch.hi[axis] = std::max(patch.hi[axis], p[v][axis]);
  }
  return patch;
}

std::vector<FoamPatch> patches_of(const MeshParts& mesh, std::span<const std::string> names) {
  std::vector<FoamPatch> patches;
  for (const Part& part : mesh.parts(Part::Origin::kPatch))
    if (part.members.front() < mesh.mesh().boundary.size())
      patches.push_back(patch_of(mesh, part, names[static_cast<std::size_t>(&part - mesh.parts().data())]));
  return patches;
}

std::string head(std::string_view type, std::string_view name) {
  return fmt::format("FoamFile\n{{\n    version 2.0;\n    format ascii;\n    class {};\n    object {};\n}}\n\n", type,
                     name);
}

/// Text of each role's condition; slip where the list says nothing of it.
struct Conditions {
  std::string inlet, outlet, road, wall;
  const std::string& of(Role role) const {
    static const std::string slip = "type slip;", symmetry = "type symmetry;";
    switch (role) {
      case Role::kInlet:
        return inlet;
      case Role::kOutlet:
        return outlet;
      case Role::kRoad:
        return road;
      case Role::kWall:
        return wall;
      case Role::kSymmetry:
        return symmetry;
      default:
        return slip;
    }
  }
};

class FoamCase {
 public:
  FoamCase(const WriteOptions& options, std::vector<FoamPatch> patches)
      : speed_(*options.speed),
        nu_(viscosity_of(options.fluid)),
        metres_(metres_of_case(options)),
        patches_(std::move(patches)) {}

  bool is_tunnel() const {
    return std::ranges::any_of(patches_, [](const FoamPatch& p) { return p.role == Role::kSlip; });
  }
  bool has(Role role) const {
    return std::ranges::any_of(patches_, [&](const FoamPatch& p) { return p.role == role; });
  }
  double k() const { return 1.5 * kIntensity * kIntensity * speed_ * speed_; }
  double omega() const { return k() / (kViscosityRatio * nu_); }

  std::string field(const char* name, const char* type, const char* dimensions, const std::string& inside,
                    const Conditions& conditions) const {
    std::string text = head(type, name) + fmt::format("dimensions {};\ninternalField uniform {};\nboundaryField\n{{\n",
                                                      dimensions, inside);
    for (const FoamPatch& p : patches_) text += fmt::format("    {} {{ {} }}\n", p.name, conditions.of(p.role));
    return text + "}\n";
  }

  std::string velocity() const {
    const std::string along = fmt::format("({:.9g} 0 0)", speed_);
    return field("U", "volVectorField", "[0 1 -1 0 0 0 0]", is_tunnel() ? along : "(0 0 0)",
                 {fmt::format("type surfaceNormalFixedValue; refValue uniform {:.9g};", -speed_),
                  "type inletOutlet; inletValue uniform (0 0 0); value uniform (0 0 0);",
                  fmt::format("type fixedValue; value uniform {};", along), "type noSlip;"});
  }
  std::string pressure() const {
    return field(
        "p", "volScalarField", "[0 2 -2 0 0 0 0]", "0",
        {"type zeroGradient;", "type fixedValue; value uniform 0;", "type zeroGradient;", "type zeroGradient;"});
  }
  /// Of k, omega and nut, whose walls have functions that hold at any y+.
  std::string turbulence(const char* name, const char* dimensions, double value, const char* function) const {
    const std::string in = fmt::format("{:.9g}", value);
    const std::string wall = fmt::format("type {}; value uniform {};", function, in);
    return field(name, "volScalarField", dimensions, in,
                 {fmt::format("type fixedValue; value uniform {};", in),
                  fmt::format("type inletOutlet; inletValue uniform {0}; value uniform {0};", in), wall, wall});
  }
  std::string eddy_viscosity() const {
    const std::string any = "type calculated; value uniform 0;";
    const std::string wall = "type nutUSpaldingWallFunction; value uniform 0;";
    return field("nut", "volScalarField", "[0 2 -1 0 0 0 0]", fmt::format("{:.9g}", kViscosityRatio * nu_),
                 {any, any, wall, wall});
  }

  std::string forces() const {
    std::string walls;
    double shadow = 0, low = HUGE_VAL, high = -HUGE_VAL;
    for (const FoamPatch& p : patches_) {
      if (p.role != Role::kWall) continue;
      walls += (walls.empty() ? "" : " ") + p.name;
      shadow += p.shadow, low = std::min(low, p.lo.x), high = std::max(high, p.hi.x);
    }
    if (walls.empty()) return "";
    std::string text = fmt::format(
        "    forces\n    {{\n        type forces;\n        libs (\"libforces.so\");\n        patches ({});\n"
        "        rho rhoInf;\n        rhoInf 1;\n        CofR (0 0 0);\n        writeControl timeStep;\n"
        "        writeInterval 1;\n    }}\n",
        walls);
    if (is_tunnel() && shadow > 0)
      text += fmt::format(
          "    // Aref: the walls' area as seen along x, of a body without hollows; lRef: their length along x.\n"
          "    forceCoeffs\n    {{\n        type forceCoeffs;\n        libs (\"libforces.so\");\n        patches "
          "({});\n"
          "        rho rhoInf;\n        rhoInf 1;\n        CofR (0 0 0);\n        liftDir (0 0 1);\n"
          "        dragDir (1 0 0);\n        pitchAxis (0 1 0);\n        magUInf {:.9g};\n        lRef {:.9g};\n"
          "        Aref {:.9g};\n        writeControl timeStep;\n        writeInterval 1;\n    }}\n",
          walls, speed_, (high - low) * metres_, shadow * metres_ * metres_);
    return text;
  }

  std::string control() const {
    return head("dictionary", "controlDict") +
           fmt::format(
               "application simpleFoam;\nstartFrom latestTime;\nstartTime 0;\nstopAt endTime;\nendTime {0};\n"
               "deltaT 1;\nwriteControl timeStep;\nwriteInterval {0};\npurgeWrite 2;\nwriteFormat ascii;\n"
               "writePrecision 8;\ntimeFormat general;\nrunTimeModifiable true;\nfunctions\n{{\n",
               kIterations) +
           forces() +
           "    yPlus\n    {\n        type yPlus;\n        libs (\"libfieldFunctionObjects.so\");\n"
           "        writeControl writeTime;\n    }\n}\n";
  }

  double speed() const { return speed_; }
  double nu() const { return nu_; }

 private:
  double speed_, nu_, metres_;
  std::vector<FoamPatch> patches_;
};

// SIMPLEC. Limiters switch on and off in cells of tetrahedra: a smooth one lets residuals fall, and none at all lets
// the velocity grow without bound from the start. A limited gradient of the pressure would add drag.
constexpr const char* kSchemes =
    "ddtSchemes { default steadyState; }\ngradSchemes\n{\n    default Gauss linear;\n"
    "    \"grad\\((U|k|omega)\\)\" cellLimited<Venkatakrishnan> Gauss linear 1;\n}\ndivSchemes\n{\n"
    "    default none;\n    div(phi,U) bounded Gauss linearUpwind grad(U);\n    div(phi,k) bounded Gauss upwind;\n"
    "    div(phi,omega) bounded Gauss upwind;\n    div((nuEff*dev2(T(grad(U))))) Gauss linear;\n}\n"
    "laplacianSchemes { default Gauss linear limited corrected 0.5; }\ninterpolationSchemes { default linear; }\n"
    "snGradSchemes { default limited corrected 0.5; }\nwallDist { method meshWave; }\n";

constexpr const char* kSolution =
    "solvers\n{\n    p { solver GAMG; smoother GaussSeidel; tolerance 1e-9; relTol 0.05; }\n    Phi { $p; }\n"
    "    \"(U|k|omega)\" { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-10; relTol 0.1; }\n}\n"
    "SIMPLE\n{\n    consistent yes;\n    nNonOrthogonalCorrectors 1;\n    pRefCell 0;\n    pRefValue 0;\n"
    "    residualControl { p 1e-3; U 1e-3; \"(k|omega)\" 1e-4; }\n}\n"
    "potentialFlow { nNonOrthogonalCorrectors 5; }\n"
    "relaxationFactors { equations { U 0.9; k 0.7; omega 0.7; } }\n";

void put(const fs::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw OutputError(fmt::format("{}: cannot be written", file.string()));
}

fs::path case_folder(const fs::path& target) {
  return target.parent_path().parent_path();
}

}  // namespace

std::string_view foam_type_of(std::string_view name) {
  const Role role = role_of(name);
  if (role == Role::kSymmetry) return "symmetry";
  return role == Role::kWall || role == Role::kRoad ? "wall" : "patch";
}

double metres_of_case(const WriteOptions& options) {
  if (!options.deck || options.unit.empty()) return 1;
  if (const LengthUnit* unit = unit_named(options.unit)) return unit->metres;
  throw OptionError(fmt::format("`unit`: \"{}\" is no unit of length", options.unit));
}

void check_foam_case(const fs::path& target, const WriteOptions& options) {
  if (!options.deck) return;
  if (target.filename() != "polyMesh" || target.parent_path().filename() != "constant")
    throw OptionError(fmt::format("{}: a case is written around CASE/constant/polyMesh: name that", target.string()));
  if (options.parts > 0) throw OptionError("`deck` writes a case that is whole: let decomposePar divide it");
  if (!options.speed) throw OptionError("`deck` of OpenFOAM needs the speed at the inlet: `speed`, in m/s");
  viscosity_of(options.fluid);
  metres_of_case(options);
  const fs::path folder = case_folder(target);
  for (const fs::path& file : {folder / "0", folder / "system", folder / "constant" / "transportProperties",
                               folder / "constant" / "turbulenceProperties"})
    if (fs::exists(file))
      throw OutputError(fmt::format(
          "{}: is there already, and `deck` writes over no case; remove it, or leave out `deck`", file.string()));
}

void write_foam_case(MeshOutput& out, const MeshParts& mesh, std::span<const std::string> names) {
  if (!out.options().deck) return;
  const FoamCase all(out.options(), patches_of(mesh, names));
  for (const Role role : {Role::kInlet, Role::kOutlet})
    if (!all.has(role))
      out.note(fmt::format("no patch is called {0}...: what should be is a wall in the case",
                           role == Role::kInlet ? "inlet" : "outlet"));
  const fs::path folder = case_folder(out.target());
  const fs::path start = out.folder(folder / "0"), system = out.folder(folder / "system");
  put(start / "U", all.velocity());
  put(start / "p", all.pressure());
  put(start / "k", all.turbulence("k", "[0 2 -2 0 0 0 0]", all.k(), "kqRWallFunction"));
  put(start / "omega", all.turbulence("omega", "[0 0 -1 0 0 0 0]", all.omega(), "omegaWallFunction"));
  put(start / "nut", all.eddy_viscosity());
  put(system / "controlDict", all.control());
  put(system / "fvSchemes", head("dictionary", "fvSchemes") + kSchemes);
  put(system / "fvSolution", head("dictionary", "fvSolution") + kSolution);
  put(out.path_for_library("transportProperties"),
      head("dictionary", "transportProperties") + fmt::format("transportModel Newtonian;\nnu {:.9g};\n", all.nu()));
  put(out.path_for_library("turbulenceProperties"),
      head("dictionary", "turbulenceProperties") +
          "simulationType RAS;\nRAS { RASModel kOmegaSST; turbulence on; printCoeffs on; }\n");
  const double metres = metres_of_case(out.options());
  out.note(fmt::format("case for simpleFoam: {:.6g} m/s, nu {:.4g} m2/s, k-omega SST; coordinates {} metres there",
                       all.speed(), all.nu(), metres == 1 ? "count" : fmt::format("times {:g} are", metres)));
}

}  // namespace octafront::io
