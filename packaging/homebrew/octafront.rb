# From a checkout: brew install --HEAD --formula packaging/homebrew/octafront.rb
class Octafront < Formula
  desc "Tetrahedral finite element meshes from closed surfaces"
  homepage "https://octafront.invalid"
  license "Apache-2.0"
  head File.expand_path("../..", __dir__), using: :git

  depends_on "cli11" => :build
  depends_on "cmake" => :build
  depends_on "ninja" => :build
  depends_on "nlohmann-json" => :build
  depends_on "fmt"
  depends_on "hdf5"
  depends_on "tbb"

  uses_from_macos "zlib"

  def install
    system "cmake", "-S", ".", "-B", "build", "-G", "Ninja", "-DBUILD_SHARED_LIBS=ON", "-DOCTAFRONT_CAD=OFF",
           "-DOCTAFRONT_BUILD_TESTS=OFF", "-DOCTAFRONT_BUILD_PYTHON=OFF", "-DOCTAFRONT_BUILD_EXAMPLES=OFF", *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
    pkgshare.install "samples"
  end

  test do
    system bin/"octafront", "mesh", pkgshare/"samples/bracket.stl", "-o", "part.vtu", "--size", "3"
    assert_predicate testpath/"part.vtu", :exist?
  end
end
