#pragma once

#include <octafront/image.h>
#include <octafront/mesh_field.h>
#include <octafront/no_context.h>
#include <octafront/tet_mesh.h>

#include <string>
#include <vector>

namespace octafront {

/// The values of an image on a mesh in the same coordinates.
struct ImageSamples {
  MeshField of_elements, at_points;  ///< one number each, mid-side nodes too
  std::vector<std::string> notes;
};

/// Samples `image` on `mesh`: an element has the mean of the voxels whose middles it holds, between its corners; one
/// that holds fewer than eight the mean of four points of quadrature, each linear between the voxels around. A node has
/// what is linear between the voxels around it. Beyond the outermost middles values stay what they are there. Throws
/// InputError where no element has its middle in the image; Cancelled. The same bits on any number of threads.
ImageSamples sample_image(const TetMesh& mesh, const Image& image, const std::string& name,
                          const RunContext& context = no_context());

/// The image with x and y turned where one of its frame and `frame` is LPS and the other RAS; as it is if either is
/// unknown.
Image in_frame(Image image, const std::string& frame);

}  // namespace octafront
