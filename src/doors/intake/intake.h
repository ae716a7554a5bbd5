#pragma once

#include <octafront/domain.h>
#include <octafront/image.h>

#include "cad/reader/cad_reader.h"
#include "soup/cells/misfit.h"

#include <optional>
#include <string>
#include <vector>

namespace octafront::intake {

// doors/intake: the way in. Takes files, bodies, arrays and images; asks cells, mend and nets, in the order that all
// doors share; leaves a Domain: what generate() meshes, and what was found and done (octafront/domain.h).

/// Enters a note into the domain, and tells it.
void note(Domain& domain, const IntakeOptions& options, std::string stage, std::string text);
void note_all(Domain& domain, const IntakeOptions& options, const std::string& stage,
              const std::vector<std::string>& texts);

/// Makes a complex the surface of the domain; says what regions it has, and their volumes.
void take_complex(Domain& domain, const IntakeOptions& options, Complex complex);

/// What the options know of the mesh to come.
cells::ElementsToCome elements_to_come(const IntakeOptions& options);

/// One region alone needs no name: it is "body" then.
std::string region_name(const Domain& domain, std::size_t region);

/// What is left to do with a CAD file.
struct CadTaken {
  bool is_clean = false;          ///< nothing: the domain's surface can be meshed
  bool closes_gaps = false;       ///< `bodies` are clean, and nearer to each other than `tolerance`
  std::vector<Body> bodies = {};  ///< solids to be joined; empty: the domain's surface is to be mended
};

/// Reads a CAD file into the domain: triangles, patches, names, the true geometry.
CadTaken take_cad(Domain& domain, const IntakeOptions& options, const std::string& file, const RunContext& context);

/// After `taken.bodies`, mended, were joined in the domain. Throws InputError where they overlap and nobody said who
/// gets what they share.
void finish_joined_cad(Domain& domain, const CadTaken& taken, ComplexOptions::Overlap overlap);

/// Makes the complex of an image the surface of the domain, with what its reader had to say. `name` is that of the
/// file, or empty.
void take_image(Domain& domain, const IntakeOptions& options, const Image& image, const std::string& name,
                const RunContext& context);

/// The domain with the sheets, lines and points that the options want inside.
Domain with_inside(Domain domain, const IntakeOptions& options, const RunContext& context);

/// In the place of the domain what lies around it in the wind tunnel that the options ask for; as it is if they ask for
/// none.
Domain in_tunnel(Domain domain, const IntakeOptions& options, const RunContext& context);

/// Throws OptionError if something is asked of formulas, for an input `name` that is none.
void refuse_formula_options(const FormulaIntake& formula, const std::string& name);

/// Throws OptionError if something is asked of images, for an input `name` that is none.
void refuse_image_options(const IntakeOptions& options, const std::string& name);

/// What IntakeOptions::contacts and `contact` say.
struct ContactsAsked {
  std::string of_labels;  ///< an area, or "keep"; empty: nothing
  ContactChoice of_parts;
};
/// The area that a text says; nullopt: it says none.
std::optional<double> area_in(const std::string& text);
/// Throws OptionError for what is neither; InputError for a file that says something else.
ContactsAsked contacts_asked(const IntakeOptions& options);

// How a CAD file is read, by the options of the way in.

/// Throws OptionError.
void check_cad_intake(const CadIntake& asked);

cad::ReaderOptions reader_options(const IntakeOptions& options);

/// How many millimetres the unit has that is asked for.
double millimetres_of(const CadIntake& asked);
/// The same in the unit that a model's lengths are in.
double unit_of(const cad::CadModel& model, const CadIntake& asked);

// Grey images whose details no mesh of automatic size can have.

/// The image in coarser voxels, if ImageIntake::most_elements asks for it; its last note says what was given up.
std::optional<Image> coarsened_for_budget(const Image& image, const ImageIntake& asked, const ImageRegions& regions,
                                          const RunContext& context);

}  // namespace octafront::intake
