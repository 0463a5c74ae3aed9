#include "tools/fields/field_recorder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hoof::tools {
namespace {

std::string formatted(const char* format, double value) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

void put(sim::ByteWriter& out, const std::optional<FieldMoment>& moment) {
  out.put(moment.has_value());
  if (moment) tools::put(out, *moment);
}

void get(sim::ByteReader& in, std::optional<FieldMoment>& moment) {
  moment.reset();
  if (in.get<bool>()) moment = get_moment(in);
}

}  // namespace

FieldMoment FieldRecorder::look(const std::string& name, const sim::Observation& plant,
                                const sim::Rig& rig, const sim::SandBed& bed) const {
  FieldMoment m;
  m.name = name;
  m.time_s = plant.time_s;
  m.depth_m = plant.depth_m;
  m.foot_m = plant.foot_m;
  m.ground_N = plant.ground_N;
  for (int body = 0; body < rig.body_count(); ++body) m.poses.push_back(rig.pose(body));
  m.sand = bed.state(plan_.region_m);
  m.touches = bed.mesh_touches();
  return m;
}

/// The planned moment that this tick is the first at or after.
std::optional<std::string> FieldRecorder::due(const sim::Observation& plant) {
  std::optional<std::string> name;
  if (plan_.is_traction()) {
    if (!in_first_stance_) return name;
    const double turns = plan_.turns(plant.foot_m);
    for (; next_ < plan_.phases_turns.size() && turns >= plan_.phases_turns[next_]; ++next_) {
      name = "phase " + formatted("%.2f", plan_.phases_turns[next_]);
    }
    return name;
  }
  constexpr double kRounding_s = 1e-9;
  const double since_s = plant.time_s - contact_s_ + kRounding_s;
  for (; next_ < plan_.after_contact_s.size() && since_s >= plan_.after_contact_s[next_]; ++next_) {
    name = "after " + formatted("%.0f ms", 1e3 * plan_.after_contact_s[next_]);
  }
  return name;
}

void FieldRecorder::look_for_greatest_depth(const sim::Observation& plant, const sim::Rig& rig,
                                            const sim::SandBed& bed) {
  if (loaded_ticks_ % FieldPlan::kLook_ticks != 0 || plant.depth_m <= best_) return;
  best_ = plant.depth_m;
  extreme_ = look("greatest depth", plant, rig, bed);
}

/// The mean about a tick is known half a mean later.
void FieldRecorder::look_for_peak(const sim::Observation& plant, const sim::Rig& rig,
                                  const sim::SandBed& bed) {
  fx_N_.push_back(plant.ground_N.x());
  if (fx_N_.size() > FieldPlan::kMean_ticks) fx_N_.pop_front();
  static_assert(FieldPlan::kLook_ticks == FieldPlan::kMean_ticks / 2);
  if (loaded_ticks_ % FieldPlan::kLook_ticks != 0) return;
  double mean_N = 0;
  for (const double fx_N : fx_N_) mean_N += fx_N / double(fx_N_.size());
  if (pending_ && fx_N_.size() == FieldPlan::kMean_ticks && mean_N > best_) {
    best_ = mean_N;
    extreme_ = std::move(pending_);
  }
  pending_.reset();
  // A tick that is to be a peak is not far below the highest one.
  if (plant.ground_N.x() > 0.5 * best_) pending_ = look("peak Fx", plant, rig, bed);
}

void FieldRecorder::tick(const sim::Observation& plant, const sim::Rig& rig,
                         const sim::SandBed& bed) {
  if (plant.time_s <= last_time_s_) return;  // seen before the checkpoint
  last_time_s_ = plant.time_s;
  if (plant.phase != sim::Phase::kLoaded) return;
  if (contact_s_ < 0) {
    contact_s_ = plant.time_s;
    if (plan_.is_traction()) {
      const double turns = plan_.turns(plant.foot_m);
      while (next_ < plan_.phases_turns.size() && plan_.phases_turns[next_] < turns) ++next_;
    }
    moments_.push_back(look("contact", plant, rig, bed));
  }
  if (plan_.is_traction() && plan_.turns(plant.foot_m) > 0.9) in_first_stance_ = false;
  if (const auto name = due(plant)) moments_.push_back(look(*name, plant, rig, bed));
  if (plan_.is_traction()) {
    look_for_peak(plant, rig, bed);
  } else {
    look_for_greatest_depth(plant, rig, bed);
  }
  ++loaded_ticks_;
}

std::string FieldRecorder::save() const {
  sim::ByteWriter out;
  out.put(last_time_s_), out.put(contact_s_), out.put(loaded_ticks_), out.put(next_);
  out.put(in_first_stance_), out.put(best_);
  out.put_all(std::vector<double>(fx_N_.begin(), fx_N_.end()));
  put(out, extreme_), put(out, pending_);
  out.put(std::uint64_t(moments_.size()));
  for (const FieldMoment& m : moments_) tools::put(out, m);
  return out.take();
}

void FieldRecorder::restore(std::string_view bytes) {
  sim::ByteReader in(bytes);
  in.get(last_time_s_), in.get(contact_s_), in.get(loaded_ticks_), in.get(next_);
  in.get(in_first_stance_), in.get(best_);
  std::vector<double> fx_N;
  in.get_all(fx_N);
  fx_N_.assign(fx_N.begin(), fx_N.end());
  get(in, extreme_), get(in, pending_);
  moments_.clear();
  for (auto count = in.get<std::uint64_t>(); count > 0; --count) {
    moments_.push_back(get_moment(in));
  }
}

std::vector<FieldMoment> FieldRecorder::finish(const sim::Observation& last, const sim::Rig& rig,
                                               const sim::SandBed& bed) {
  if (moments_.empty()) return {};
  if (extreme_) {
    std::erase_if(moments_, [this](const FieldMoment& m) {
      return m.time_s == extreme_->time_s && &m != &moments_.front();
    });
    moments_.push_back(*std::exchange(extreme_, {}));
  }
  if (!plan_.is_traction()) moments_.push_back(look("end", last, rig, bed));
  std::stable_sort(moments_.begin(), moments_.end(),
                   [](const FieldMoment& a, const FieldMoment& b) { return a.time_s < b.time_s; });
  return std::move(moments_);
}

}  // namespace hoof::tools
