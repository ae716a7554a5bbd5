#pragma once

// images/nets: what voxels bound. Takes an image of labels or grey values; leaves one net of surfaces between all of
// them: a vertex for each corner of voxels where several meet, a quad for each face of voxels between two. The net is
// a complex as it stands; smoothing moves its vertices within their cells, and what would cross goes back.
