#pragma once

#include <octafront/named_groups.h>
#include <octafront/vec.h>

#include <optional>
#include <string>
#include <vector>

namespace octafront {

// What makes a mesh a job that a solver of structures runs: materials, supports, loads, contacts (docs/use/jobs.md).
// Forces, moduli and densities are written as they are given: their units must fit those of the mesh.

struct JobMaterial {
  std::string name;
  double young = 0;  ///< Young's modulus, > 0
  double poisson = 0.3;
  std::optional<double> density = {};
};

/// What a region is made of.
struct JobPart {
  std::string place;     ///< empty: all that no other names
  std::string material;  ///< one of SolverJob::materials
};

/// What holds: a place, or a reference point.
struct JobFix {
  std::string place;
  /// Of "xyz"; of a reference point also "r", its rotations. Empty: all of them.
  std::string axes = {};
  /// In the system of the cylinder that the place is: of "radial", "tangential", "axial"; then `axes` is not heeded.
  std::vector<std::string> of_cylinder = {};
};

/// A force, spread evenly over the faces of a place, or at a reference point.
struct JobLoad {
  std::string place;
  Vec3 force;
};

/// A pressure on the faces of a place; < 0: they are pulled.
struct JobPressure {
  std::string place;
  double value = 0;
};

/// What becomes of an opened contact (TetMesh::opened_contacts). Those of two parts that none names are tied, what is
/// open inside a part stays so.
struct JobContact {
  std::string place;                    ///< "A|B" or "B|A"; empty: all that no other names
  std::optional<double> friction = {};  ///< its coefficient, >= 0, of faces that may slide and lift off; none: tied
};

/// A bolt that is drawn together by this force, in a section across the middle of its shank.
struct JobPretension {
  std::string region;
  double force = 0;
};

/// A reference point that faces follow.
struct JobCoupling {
  std::string name;
  std::string place;
  std::optional<Vec3> at = {};  ///< none: the middle of the faces, by area
  bool is_rigid = true;         ///< they keep their shape; else they share its forces and it follows them, on average
};

/// What the input says that a part weighs: of materials without a density, and of the placeholder.
struct JobDensity {
  std::string part;  ///< its region, by name
  double value = 0;  ///< > 0, in the units of the job: of CAD by density_with_newtons() of octafront/units.h
};

struct SolverJob {
  std::vector<JobMaterial> materials;
  std::vector<JobPart> parts;
  std::vector<JobFix> fixes;
  std::vector<JobLoad> loads;
  std::vector<JobPressure> pressures;
  std::vector<JobContact> contacts;
  std::vector<JobPretension> pretensions;
  std::vector<JobCoupling> couplings;
  std::vector<JobDensity> densities = {};
  std::optional<Vec3> gravity = {};  ///< an acceleration of all parts; their materials need a density
};

/// Adds what a text of JSON says to a job (docs/use/jobs.md has all of it):
///   {"materials": {"default": {"name": "steel", "E": 210000, "nu": 0.3, "density": 7.85e-9}},
///    "fix": {"ground": "xyz"}, "load": {"wall": [0, 0, -100]}}
/// `name`: what messages call it. Throws OptionError for whatever is not exactly that.
void add_to_job(SolverJob& job, const std::string& text, const std::string& name = "job");

/// The same from a file. Throws InputError where it cannot be read.
/// `key`: the file is what stands under this key.
void add_file_to_job(SolverJob& job, const std::string& file, const std::string& key = {});

/// Refuses names that a mesh with these places will not have, before it is made (expected_place_names() of
/// octafront/generate.h). Throws OptionError, which lists those that there are.
void check_job(const SolverJob& job, const PlaceNames& there);

/// The places that are meant by what they are like, "largest plane at z min": of CAD they are known to generate()
/// alone, as Options::groups "PLACE=PLACE".
std::vector<std::string> places_by_shape(const SolverJob& job);

}  // namespace octafront
