#include <octafront/mend.h>

#include <nlohmann/json.hpp>

namespace octafront {

std::string to_json(const MendReport& r) {
  using Json = nlohmann::ordered_json;
  Json changes = Json::array();
  for (const MendChange& c : r.changes) {
    Json change{{"kind", name_of(c.kind)}, {"at", Json{c.at.x, c.at.y, c.at.z}}, {"size", c.size}, {"faces", c.faces}};
    if (c.first_face != kNone) change["first_face"] = c.first_face;
    if (c.kind == MendChange::Kind::kClosed) change["within_tolerance"] = c.within_tolerance;
    changes.push_back(std::move(change));
  }
  return Json{{"clean", r.clean},
              {"tolerance", r.tolerance},
              {"diagonal", r.diagonal},
              {"largest_move", r.largest_move},
              {"joined_vertices", r.joined_vertices},
              {"divided_edges", r.divided_edges},
              {"crossing_pairs", r.crossing_pairs},
              {"separated_vertices", r.separated_vertices},
              {"based_holes", r.based_holes},
              {"area_before", r.area_before},
              {"area_after", r.area_after},
              {"volume_before", r.volume_before},
              {"volume_after", r.volume_after},
              {"bodies", r.bodies},
              {"notes", r.notes},
              {"changes", changes}}
      .dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace octafront
