#pragma once

#include "part.h"

#include <TDocStd_Document.hxx>
#include <TopoDS_TShape.hxx>
#include <string>
#include <unordered_map>

namespace octafront::cad {

/// Reads the file by what it holds. Throws Refusal.
Part read_part(const Arguments& arguments);

/// What the entities of a file say of shapes, wherever these are placed.
using LabelsOfShapes = std::unordered_map<const TopoDS_TShape*, Labels>;
using DensitiesOfShapes = std::unordered_map<const TopoDS_TShape*, double>;
struct SaidOfShapes {
  LabelsOfShapes labels = {};
  DensitiesOfShapes densities = {};  ///< kg/m3
};

/// `path` is what OpenCASCADE opens; `name` is for messages.
void read_step(const std::string& path, const std::string& name, bool keep_going, Part& part);
void read_iges(const std::string& path, const std::string& name, bool keep_going, Part& part);

/// Solids and loose faces of a document, named: by `said` first, then by the document's own labels.
void take_document(const Handle(TDocStd_Document) & document, const SaidOfShapes& said, Part& part);
/// The same of a shape without names.
void take_shape(const TopoDS_Shape& shape, Part& part);
/// Equal names get numbers, in order: "bolt", "bolt#2". Solids without a name stay so.
void number_names(Part& part);

/// A part of the file that could not be read ends the reading, or is a note if the user goes on without it: told
/// at once, for what follows may crash over it.
void lost(const std::string& sentence, bool keep_going);

}  // namespace octafront::cad
