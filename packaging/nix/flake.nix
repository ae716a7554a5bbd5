# nix build "git+file://$PWD?dir=packaging/nix": the sources are those that it lies in.
{
  description = "Tetrahedral finite element meshes from closed surfaces";
  inputs.nixpkgs.url = "github:NixOS/nixpkgs/nixos-unstable";

  outputs = { self, nixpkgs }:
    let
      systems = [ "x86_64-linux" "aarch64-linux" "x86_64-darwin" "aarch64-darwin" ];
      each = make: nixpkgs.lib.genAttrs systems (system: make nixpkgs.legacyPackages.${system});
    in {
      packages = each (pkgs: {
        default = pkgs.stdenv.mkDerivation {
          pname = "octafront";
          version = "0.1.0";
          src = ../..;
          nativeBuildInputs = [ pkgs.cmake pkgs.ninja ];
          buildInputs = [ pkgs.tbb pkgs.fmt pkgs.zlib pkgs.cli11 pkgs.nlohmann_json pkgs.hdf5 ];
          cmakeFlags = [ "-DOCTAFRONT_CAD=OFF" "-DOCTAFRONT_BUILD_TESTS=OFF" "-DOCTAFRONT_BUILD_PYTHON=OFF" "-DOCTAFRONT_BUILD_EXAMPLES=OFF" ];
          meta.license = pkgs.lib.licenses.asl20;
          meta.mainProgram = "octafront";
        };
      });
    };
}
