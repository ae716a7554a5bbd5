#pragma once

#include "cad/model/cad_model.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace octafront::cad {

// How octafront-cad and who started it talk. What comes from it is a row of frames: one byte that tells what it is, the
// length of what follows as 8 bytes, little-endian, and that many bytes. What goes to it are lines of text:
//   triangulate DEFLECTION ANGLE    answered by frames kProgress and kNote, then kModel or kError
//   end
// It first reads the file, and sends kOpened, or kError.

enum class FrameKind : std::uint8_t {
  kProgress = 'P',  ///< where(): stage, then what it works on
  kNote = 'N',      ///< a sentence for the user
  kOpened =
      'O',  ///< the model without triangles: solids, faces, which meet in edges; of geometry what few numbers give
  kModel = 'M',
  kError = 'E',  ///< a sentence for the user; the end of an answer
};

/// Who gets the space that solids share: nobody, for they are refused, or stay as they are with a note; the first of
/// them, the last, or a region of its own.
enum class Overlap { kRefuse, kTell, kFirst, kLater, kNew };
/// As arguments of the program have it; nothing for a word that is none.
std::string word_of(Overlap overlap);
std::optional<Overlap> overlap_of(std::string_view word);

/// Where a reader is: what a message says if it dies there.
struct Where {
  std::string stage;  ///< "reading", "healing", "fusing", "triangulating"
  std::string what;   ///< "face 12 (fillet)", or empty
  double done = 0;    ///< part of the stage, 0 to 1
  Vec3 lo, hi;        ///< box of what it works on; equal: not known
};

/// What is known before triangles are made.
struct Opened {
  Vec3 lo, hi;  ///< box of the true geometry, millimetres
  CadModel model;
};

std::string to_bytes(const Where& where);
std::string to_bytes(const Opened& opened);
std::string to_bytes(const CadModel& model);

/// Throw InputError where the bytes are no such thing: cut off, or numbers out of range.
Where where_of(std::string_view bytes);
Opened opened_of(std::string_view bytes);
CadModel model_of(std::string_view bytes);

/// The nine bytes before the content of a frame.
inline constexpr std::size_t kFrameHead = 9;
std::string frame_head(FrameKind kind, std::uint64_t length);
struct Head {
  FrameKind kind;
  std::uint64_t length;
};
/// Of at least kFrameHead bytes; nothing if no frame begins so.
std::optional<Head> head_of(std::string_view bytes);

}  // namespace octafront::cad
