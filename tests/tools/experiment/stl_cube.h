#pragma once

#include <array>
#include <string>

namespace hoof::tests {

/// A cube of 40 mm as ASCII STL; an open one lacks a face.
inline std::string stl_cube(bool closed) {
  constexpr std::array<std::array<int, 4>, 6> kFaces = {
      {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}};
  const auto vertex = [](int corner) {
    const auto at = [corner](int bit) { return corner >> bit & 1 ? " 40" : " 0"; };
    return std::string("vertex") + at(2) + at(1) + at(0) + "\n";
  };
  std::string text = "solid cube\n";
  for (std::size_t i = 0; i < (closed ? 6U : 5U); ++i) {
    const auto& f = kFaces[i];
    for (const auto& t : {std::array{f[0], f[1], f[2]}, std::array{f[0], f[2], f[3]}}) {
      text += "facet normal 0 0 0\nouter loop\n";
      for (const int corner : t) text += vertex(corner);
      text += "endloop\nendfacet\n";
    }
  }
  return text + "endsolid cube\n";
}

}  // namespace hoof::tests
