#include "fields.h"

#include <octafront/error.h>
#include <octafront/formula.h>
#include <octafront/image_samples.h>
#include <octafront/named_groups.h>

#include <algorithm>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

void add_samples(Session& session, const TetMesh& mesh, std::vector<MeshField>& fields) {
  for (const auto& [file, name] : session.arguments().samples) {
    session.context().report("samples", -1);
    const Image image = in_frame(read_image(file, {}, session.context()), session.frame);
    ImageSamples samples = sample_image(mesh, image, name, session.context());
    std::vector<std::string> notes = image.notes;
    notes.insert(notes.end(), samples.notes.begin(), samples.notes.end());
    session.say_notes("samples", notes);
    fields.push_back(std::move(samples.at_points));
    fields.push_back(std::move(samples.of_elements));
  }
}

Json json_of(const FieldBin& bin) {
  return {{"set", bin.set},   {"mean", bin.mean},         {"least", bin.least},
          {"most", bin.most}, {"elements", bin.elements}, {"volume", bin.volume}};
}

}  // namespace

bool asks_for_fields(const Arguments& a) {
  return !a.samples.empty() || !a.formulas.empty() || a.material_bins > 0;
}

void check_asked_fields(const Arguments& a) {
  std::vector<std::string> names;
  const bool may_carry = a.command == "adapt" || a.command == "improve" || a.command == "carry" || a.command == "move";
  for (const auto& [file, name] : a.samples) {
    if (!is_image(file)) throw InputError(fmt::format("{}: --sample needs an image, and this is none", file));
    names.push_back(name);
  }
  for (const auto& [name, text] : a.formulas) {
    // Fields of the input may have names of their own.
    if (!may_carry) const Formula checked(text, 1, names);
    names.push_back(name);
  }
  if (a.material_bins > 0 && names.empty() && !may_carry)
    throw OptionError("--material-bins needs a field: give --sample IMAGE=NAME, and a law by --field if there is one");
}

void add_asked_fields(Session& session, const TetMesh& mesh, std::vector<MeshField>& fields) {
  add_samples(session, mesh, fields);
  for (const auto& [name, text] : session.arguments().formulas)
    for (const bool of_elements : {false, true})
      fields.push_back(field_by_formula(mesh, name, text, fields, of_elements));
}

std::vector<SetMaterial> bins_asked(Session& session, TetMesh& mesh, const std::vector<MeshField>& fields) {
  const auto last = std::find_if(fields.rbegin(), fields.rend(),
                                 [](const MeshField& f) { return f.of_elements && f.components == 1; });
  if (last == fields.rend()) throw OptionError("--material-bins needs a field of elements, and there is none");
  std::vector<SetMaterial> materials;
  Json told = Json::array();
  session.say(
      fmt::format("{:<16} {:>12} {:>12} {:>12} {:>10}\n", "set", "mean " + last->name, "least", "most", "elements"));
  for (const FieldBin& bin : add_bins(mesh, *last, session.arguments().material_bins)) {
    session.say(fmt::format("{:<16} {:>12.6g} {:>12.6g} {:>12.6g} {:>10}\n", bin.set, bin.mean, bin.least, bin.most,
                            bin.elements));
    materials.push_back({bin.set, last->name, bin.mean});
    told.push_back(json_of(bin));
  }
  session.found({{"material_bins", told}});
  return materials;
}

}  // namespace octafront::cli
