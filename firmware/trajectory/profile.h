// The motion of one axis as pieces of constant jerk, and its sampling.
#pragma once

#include <array>

#include "firmware/trajectory/brake.h"
#include "firmware/trajectory/signal.h"

namespace hoof::firmware::trajectory {

template <typename Real>
struct State {
  Real position = 0;
  Real velocity = 0;
  Real acceleration = 0;
};

template <typename Real>
struct Sample {
  State<Real> state;
  Real jerk = 0;
};

template <typename Real>
class Profile {
 public:
  // Two signals of seven phases have twelve borders inside, hence thirteen pieces; two more brake.
  static constexpr int kMaxPieces = 2 + 2 * Signal<Real>::kMaxPhases - 1;

  struct Piece {
    Real begin_s;
    Real duration_s;
    State<Real> state;  // at begin_s, position relative to the start of the profile
    Real jerk;
  };

  // From `start`: the brake, then `mix` times `scale`, then `end` for ever. `values_are_jerk` is
  // false where the jerk is unlimited and the signals are accelerations.
  void build(const State<Real>& start, const State<Real>& end, const Brake<Real>& brake,
             const Mix<Real>& mix, Real scale, bool values_are_jerk, Real duration_s) {
    values_are_jerk_ = values_are_jerk;
    begin(start, end);
    for (int i = 0; i < brake.count; ++i) append(brake.duration_s[i], brake.value[i]);
    brake_s_ = elapsed_s_;
    if (mix.lower.count() == 0 || mix.upper.count() == 0) {
      const Signal<Real>& only = mix.upper.count() > 0 ? mix.upper : mix.lower;
      for (int i = 0; i < only.count(); ++i) append(only.duration_s(i), scale * only.value(i));
    } else {
      append_mixed(mix, scale);
    }
    duration_s_ = duration_s;
  }

  // With a velocity target the end position is where the motion leads.
  void end_where_it_leads() { end_.position = start_position_ + state_.position; }

  // Standing still at a position.
  void rest(Real position) {
    begin({position, 0, 0}, {position, 0, 0});
    duration_s_ = 0;
  }

  Real duration_s() const { return duration_s_; }
  Real brake_s() const { return brake_s_; }  // until then a start outside the limits is brought in
  int pieces() const { return count_; }
  const Piece& piece(int i) const { return pieces_[i]; }
  const State<Real>& end() const { return end_; }

  // At time_s >= 0 since the start. `hint` is the piece of the last sample, where the search
  // starts. From the end on the axis moves on from the target state with its velocity, without
  // acceleration; the sample at the end itself is the target, bit by bit.
  Sample<Real> at(Real time_s, int& hint) const {
    if (time_s >= duration_s_ || count_ == 0) {
      Sample<Real> sample{end_, 0};
      const Real beyond = time_s - duration_s_;
      if (beyond > 0) {
        sample.state.position += beyond * end_.velocity;
        sample.state.acceleration = 0;
      }
      return sample;
    }
    if (hint >= count_ || hint < 0 || pieces_[hint].begin_s > time_s) hint = 0;
    while (hint + 1 < count_ && pieces_[hint + 1].begin_s <= time_s) ++hint;
    const Piece& piece = pieces_[hint];
    // begin_s is rounded to the size of the whole profile; the duration is not, and keeps the
    // limits.
    const Real t = minimum(time_s - piece.begin_s, piece.duration_s);
    Sample<Real> sample{advanced(piece.state, piece.jerk, t), piece.jerk};
    sample.state.position += start_position_;
    return sample;
  }

  static State<Real> advanced(const State<Real>& from, Real jerk, Real t) {
    return {from.position + t * (from.velocity + t * (from.acceleration / 2 + t * jerk / 6)),
            from.velocity + t * (from.acceleration + t * jerk / 2), from.acceleration + t * jerk};
  }

 private:
  void begin(const State<Real>& start, const State<Real>& end) {
    count_ = 0;
    elapsed_s_ = 0;
    brake_s_ = 0;
    start_position_ = start.position;
    end_ = end;
    state_ = {0, start.velocity, start.acceleration};
  }

  void append(Real duration_s, Real value) {
    Piece& piece = pieces_[count_++];
    if (!values_are_jerk_) state_.acceleration = value;
    piece.begin_s = elapsed_s_;
    piece.duration_s = duration_s;
    piece.state = state_;
    piece.jerk = values_are_jerk_ ? value : Real(0);
    state_ = advanced(state_, piece.jerk, duration_s);
    elapsed_s_ += duration_s;
  }

  void append_mixed(const Mix<Real>& mix, Real scale) {
    const Real upper_weight = scale * mix.weight;
    const Real lower_weight = scale - upper_weight;
    int upper = 0;
    int lower = 0;
    Real upper_left = mix.upper.duration_s(0);
    Real lower_left = mix.lower.duration_s(0);
    for (;;) {
      const Real value =
          upper_weight * mix.upper.value(upper) + lower_weight * mix.lower.value(lower);
      const bool last_upper = upper + 1 == mix.upper.count();
      const bool last_lower = lower + 1 == mix.lower.count();
      if (last_upper && last_lower) {
        append(maximum(upper_left, lower_left), value);
        return;
      }
      // Rounding may make one signal end a hair before the other's last border.
      const bool upper_ends = last_lower || (!last_upper && upper_left <= lower_left);
      const bool lower_ends = last_upper || (!last_lower && lower_left <= upper_left);
      const Real step = upper_ends ? upper_left : lower_left;
      append(step, value);
      upper_left -= step;
      lower_left -= step;
      if (upper_ends) upper_left = mix.upper.duration_s(++upper);
      if (lower_ends) lower_left = mix.lower.duration_s(++lower);
    }
  }

  std::array<Piece, kMaxPieces> pieces_;
  int count_ = 0;
  bool values_are_jerk_ = true;
  Real start_position_ = 0;
  Real duration_s_ = 0;
  Real brake_s_ = 0;
  State<Real> end_;
  // While building.
  State<Real> state_;
  Real elapsed_s_ = 0;
};

}  // namespace hoof::firmware::trajectory
