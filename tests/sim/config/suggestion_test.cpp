#include "sim/config/suggestion.h"

#include <catch2/catch.hpp>
#include <vector>

using hoof::sim::edit_distance;
using hoof::sim::suggest;

TEST_CASE("edit distance counts insertions, deletions, replacements and swaps") {
  CHECK(edit_distance("", "") == 0);
  CHECK(edit_distance("", "abc") == 3);
  CHECK(edit_distance("abc", "") == 3);
  CHECK(edit_distance("load", "load") == 0);
  CHECK(edit_distance("laod", "load") == 1);
  CHECK(edit_distance("lod", "load") == 1);
  CHECK(edit_distance("kitten", "sitting") == 3);
}

TEST_CASE("a wrong unit suffix is suggested before a near spelling") {
  const std::vector<std::string> keys = {"height_mm", "width_mm", "width_ratio", "speed_m_s"};
  CHECK(suggest("width_cm", keys) == "width_mm");
  CHECK(suggest("width", keys) == "width_mm");
  CHECK(suggest("speed_km_h", keys) == "speed_m_s");
  CHECK(suggest("heigth_mm", keys) == "height_mm");
}

TEST_CASE("nothing is suggested where nothing is near") {
  const std::vector<std::string> keys = {"height_mm", "b"};
  CHECK(suggest("temperature_C", keys).empty());
  CHECK(suggest("x", keys).empty());
}
