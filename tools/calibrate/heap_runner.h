// Makes heaps, some at once, and keeps each as it is finished; one that is stopped goes on later
// where it was, to the same bytes.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sim/config/materials.h"
#include "tools/calibrate/heap_angle.h"
#include "tools/calibrate/heap_lab.h"

namespace hoof::tools {

struct HeapCase {
  std::string name;  // of its file, without what decides its outcome; that is hashed
  sim::Materials materials;
  HeapTest test;
};

struct HeapResult {
  HeapAngle angle;
  double time_s = 0;     // simulated, until at rest
  std::string no_angle;  // "blocked" and the like where it tells none, then all of `angle` is NaN
  std::string why;       // in a sentence

  bool tells() const { return no_angle.empty(); }
  /// All of it rolled out to a layer, in which nothing stands a grain high: an angle of 0.
  bool is_layer() const { return tells() && angle.radius_m == 0 && angle.ring_deg == 0; }
};

/// Told the share of all work that is done and what is going on, by one thread at a time; false to
/// stop.
using HeapProgress = std::function<bool(double share, const std::string& doing)>;

/// Everything that decides the outcome of a heap, as text.
std::string heap_key(const HeapCase& c);

/// Results of the cases, in their order: the same for any number of threads. One whose file is in
/// `folder` is read, not made.
/// @param threads heaps at once; each is made by one
/// @return empty where progress said to stop: what was begun is kept in `folder` too
/// A heap that tells no angle is a result like others, and kept.
/// @throws UserError where files cannot be written
std::vector<HeapResult> make_heaps(const std::vector<HeapCase>& cases,
                                   const std::filesystem::path& folder, int threads,
                                   const HeapProgress& progress);

}  // namespace hoof::tools
