#pragma once

#include <octafront/domain.h>
#include <octafront/no_context.h>
#include <octafront/vec.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace octafront {

// CAD files: STEP, IGES, BREP. They are read by a program of its own, octafront-cad, which stands on OpenCASCADE and is
// there where that was found when Octafront was built; open_domain() (octafront/domain.h) takes them like other files.

/// Whether a file is one of CAD, by its first bytes, or by its name where these do not tell.
bool is_cad(const std::string& file);

/// What a CAD file holds.
struct CadInfo {
  struct Solid {
    std::string name;
    std::string layer;
    double volume = 0, area = 0;  ///< of the true geometry
    std::string color;            ///< "#ff8000"; empty: none
    std::string product;          ///< that it is an occurrence of; empty: the file says none
    std::string material;         ///< the same
    double density = 0;           ///< kg/m3; 0: the file does not say
  };
  /// Faces of one name, which are one patch of a mesh.
  struct Patch {
    std::string name;
    std::size_t faces = 0;
    double area = 0;
    std::string shape;                ///< "plane", "cylinder of radius 3", "free face", several with "and"
    std::vector<std::string> solids;  ///< that it bounds
  };
  /// Where two solids touch, nearly touch, or overlap.
  struct Contact {
    std::array<std::string, 2> solids;
    std::string patch;  ///< by which options find it; empty where no faces are shared
    double area = 0;    ///< of the shared faces; where there is a gap of what lies face to face, about
    std::string shape;
    double gap = 0;                 ///< > 0: they nearly touch
    double overlap = 0, depth = 0;  ///< volume of what both fill, and how thick that is
  };
  /// A colour or a layer, as it becomes a set of the mesh.
  struct Group {
    std::string name;  ///< "color #ff8000", "layer NAME" of faces; "solids of color #ff8000", ...
    std::size_t faces = 0, solids = 0;
  };
  /// One of the smallest.
  struct Small {
    std::string name;  ///< by which options find it
    double size = 0;   ///< of an edge its length, of a face twice its area over the length of its edges
  };
  std::string format;          ///< "STEP", "IGES", "BREP"
  std::string unit;            ///< in words; empty: the file says none
  double to_millimetres = 1;   ///< by which its numbers are multiplied
  std::string lengths = "mm";  ///< the unit of the lengths here: CadIntake::unit
  Box3 box;
  std::vector<Solid> solids;
  std::vector<std::string> faces;  ///< their names, of the solids and of those beside them; several may share one
  std::vector<Patch> patches;      ///< the same, each name once
  std::vector<Contact> contacts;
  std::vector<std::string> edges;  ///< between faces, by the faces that meet: "face 1|face 2"; each name once
  std::vector<Group> groups;
  std::vector<Small> shortest_edges, narrowest_faces;  ///< eight at most, the smallest first
  std::uint64_t named_faces = 0;                       ///< that have a name in the file
  std::vector<std::string> notes;                      ///< what was found, healed, fused
};

/// Reads, heals and fuses as open_domain() does, and makes no triangles. Throws InputError, OptionError, Cancelled.
CadInfo read_cad_info(const std::string& file, const IntakeOptions& options = {},
                      const RunContext& context = no_context());

/// The same as one JSON object.
std::string to_json(const CadInfo& info);

}  // namespace octafront
