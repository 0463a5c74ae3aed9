#include "sim/multibody/mesh_fault.h"

#include <catch2/catch.hpp>

#include "tests/sim/multibody/cube.h"

using namespace hoof::sim;

namespace {

std::string fault_text(const TriangleMesh& mesh) {
  const auto fault = find_mesh_fault(mesh);
  return fault ? std::to_string(fault->triangle) + " " + fault->text : "none";
}

}  // namespace

TEST_CASE("each fault of a mesh is found and placed") {
  TriangleMesh mesh = make_cuboid({0, 0, 0}, {0.01, 0.02, 0.03});
  REQUIRE(fault_text(mesh) == "none");

  SECTION("hole") {
    mesh.triangles.pop_back();
    // Triangle 3-7-5 is gone; its neighbour 5-7-6 misses edge 5-7.
    CHECK(
        fault_text(mesh) ==
        "10 edge (10.000 20.000 0.000) to (10.000 0.000 30.000) mm has no neighbour: the mesh has "
        "a hole");
  }
  SECTION("turned triangle") {
    std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
    CHECK(fault_text(mesh).find("one is turned over or there twice") != std::string::npos);
  }
  SECTION("doubled triangle") {
    mesh.triangles.push_back(mesh.triangles[0]);
    CHECK(fault_text(mesh).starts_with("12 edge (0.000 0.000 0.000) to (0.000 20.000 0.000) mm"));
  }
  SECTION("inside out") {
    for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
    CHECK(fault_text(mesh) == "0 and all others face inward: the volume is negative");
  }
  SECTION("triangle without area") {
    mesh.vertices_m[1] = mesh.vertices_m[0];
    CHECK(fault_text(mesh).find("has no area") != std::string::npos);
  }
  SECTION("vertex that is not there") {
    mesh.triangles[3][1] = 8;
    CHECK(fault_text(mesh) == "3 names a vertex that does not exist");
  }
  SECTION("empty") {
    CHECK(fault_text({}) == "0 is missing: the mesh is empty");
  }
}
