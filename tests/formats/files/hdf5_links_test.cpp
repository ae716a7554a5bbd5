#include <octafront/error.h>
#include <octafront/io.h>

#include "formats/small_files.h"

#include <array>
#include <functional>
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/stat.h>

namespace octafront {
namespace {

constexpr std::array<double, 12> kPoints{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
constexpr std::array<hsize_t, 2> kShape{4, 3};

/// A dataset of the points of a tetrahedron, made as `how` says.
void put_points(hid_t file, const char* name, hid_t how = H5P_DEFAULT) {
  const hid_t space = H5Screate_simple(2, kShape.data(), nullptr);
  const hid_t set = H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT);
  if (how == H5P_DEFAULT) H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, kPoints.data());
  H5Dclose(set), H5Sclose(space);
}

class Hdf5Links : public ::testing::Test {
 protected:
  void SetUp() override {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const hid_t other = H5Fcreate((folder_ / "other.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    put_points(other, "points");
    H5Fclose(other);
    testing::write_bytes(folder_ / "secret", {reinterpret_cast<const char*>(kPoints.data()), sizeof kPoints});
  }

  /// A tetrahedron whose points `make` puts at /points.
  std::string mesh(const std::function<void(hid_t)>& make) {
    const hid_t file = H5Fcreate((folder_ / "m.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    make(file);
    H5Fclose(file);
    testing::write_bytes(folder_ / "m.xdmf", R"(<Xdmf Version="3.0"><Domain><Grid GridType="Uniform">
<Geometry GeometryType="XYZ"><DataItem Format="HDF" DataType="Float" Precision="8" Dimensions="4 3">m.h5:/points</DataItem></Geometry>
<Topology TopologyType="Tetrahedron" NumberOfElements="1"><DataItem Format="XML" DataType="Int" Dimensions="1 4">0 1 2 3</DataItem></Topology>
</Grid></Domain></Xdmf>)");
    return (folder_ / "m.xdmf").string();
  }
  std::string refusal(const std::function<void(hid_t)>& make) {
    return testing::input_error([&] { read_mesh_file(mesh(make)); });
  }
  void link(hid_t file, const char* to, const char* name) {
    H5Lcreate_external((folder_ / to).c_str(), "/", file, name, H5P_DEFAULT, H5P_DEFAULT);
  }

  const testing::TemporaryFolder folder_;
};

TEST_F(Hdf5Links, WithinTheFileAreFollowed) {
  const auto make = [](hid_t file) {
    put_points(file, "real");
    H5Lcreate_soft("/real", file, "points", H5P_DEFAULT, H5P_DEFAULT);
  };
  EXPECT_EQ(read_mesh_file(mesh(make)).mesh.tets.size(), 1U);
}

TEST_F(Hdf5Links, ToOtherFilesAreNot) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  for (const char* to : {"other.h5", "pipe", "none"}) {
    SCOPED_TRACE(to);
    EXPECT_NE(refusal([&](hid_t file) { link(file, to, "points"); }).find("links to other files"), std::string::npos);
    const auto by_two = [&](hid_t file) {
      link(file, to, "there");
      H5Lcreate_soft("/there/points", file, "points", H5P_DEFAULT, H5P_DEFAULT);
    };
    EXPECT_NE(refusal(by_two).find("m.xdmf"), std::string::npos);
  }
}

TEST_F(Hdf5Links, ValuesInOtherFilesAreNotRead) {
  const auto external = [&](hid_t file) {
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(how, (folder_ / "secret").c_str(), 0, sizeof kPoints);
    put_points(file, "points", how);
    H5Pclose(how);
  };
  const auto drawn_from_others = [&](hid_t file) {
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(2, kShape.data(), nullptr);
    H5Pset_virtual(how, space, (folder_ / "other.h5").c_str(), "points", space);
    put_points(file, "points", how);
    H5Pclose(how), H5Sclose(space);
  };
  for (const std::function<void(hid_t)>& make : {std::function<void(hid_t)>(external), {drawn_from_others}})
    EXPECT_NE(refusal(make).find("lie in other files"), std::string::npos);
}

}  // namespace
}  // namespace octafront
