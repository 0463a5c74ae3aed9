// Where an effect begins - a layer's depth, a speed - scanned: a foot that stands on a layer or has
// not reached it shows little slope towards the true depth, and each row of spines that reaches it
// is a kink.
#pragma once

#include <functional>

#include "tools/diagnose/linear_look.h"

namespace hoof::tools {

/// Which of an effect's own coordinates says where it begins: beside its size, or the ratio that
/// stands for one, the only positive one that searches start from three values of or more. -1:
/// none.
int threshold_of(const RigModel& model, const LinearStart& start);

/// Runs task(0..count-1).
using ScanTasks = std::function<void(std::size_t, const std::function<void(std::size_t)>&)>;

/// Fits of the effect beside a base, best first: all else fitted at each place of a grid that spans
/// the catalogue's starts, then closer about the best, at last the place too.
/// @param start any with a threshold
std::vector<Fit> scan_threshold(const Fitter& fitter, const LinearBase& base,
                                const LinearStart& start, const Fitter::Weights& weights,
                                const ScanTasks& for_all);

}  // namespace hoof::tools
