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
  // Two signals of seven phases have twelve borders inside, hence thirteen pieces; one more where
  // they end a rounding error apart, twice when merged from both ends; two more brake.
  static constexpr int kMaxPieces = 2 + 2 * Signal<Real>::kMaxPhases - 1 + 2;

  struct Piece {
    Real begin_s;
    Real duration_s;
    State<Real> state;  // at begin_s, position relative to the start of the profile
    Real jerk;
  };

  // A profile is built in three steps, so that a slow processor can take them one by one: begin(),
  // then lay(), then, if it is to end at a target, anchor_end().
  //
  // From `start`: the brake, then `mix` times `scale`, `duration_s` in all; on to `end` (a target),
  // or to wherever that leads with the velocity and acceleration of `end`.
  enum class End { kAtTarget, kWhereItLeads };
  void begin(const State<Real>& start, const State<Real>& end, const Brake<Real>& brake,
             Real duration_s) {
    begin(start, end);
    for (int i = 0; i < brake.count; ++i) append(brake.phase[i], 1);
    brake_s_ = elapsed_s_;
    duration_s_ = duration_s;
  }

  void lay(const Mix<Real>& mix, Real scale, End where) {
    if (mix.lower.count() == 0 || mix.upper.count() == 0) {
      const Signal<Real>& only = mix.upper.count() > 0 ? mix.upper : mix.lower;
      for (int i = 0; i < only.count(); ++i) append(only.phase(i), scale);
    } else {
      append_mixed(mix, scale, duration_s_ - brake_s_);
    }
    if (where == End::kWhereItLeads) end_.position = start_position_ + state_.position;
  }

  // The states of the last pieces are counted back from the target, so that rounding grows from
  // both ends to the middle: a slow end after a fast start is as precise as the slow end allows.
  void anchor_end() {
    Real sums[kMaxPieces];  // of the speeds up to a piece: what its rounding is proportional to
    Real sum = 0;
    for (int i = 0; i < count_; ++i) sums[i] = sum += magnitude(pieces_[i].state.velocity);
    State<Real> state{end_.position - start_position_, end_.velocity, end_.acceleration};
    sum = magnitude(state.velocity);
    for (int i = count_ - 1; i > 0 && sum < sums[i]; --i) {
      Piece& piece = pieces_[i];
      const Real t = piece.duration_s;
      state.acceleration = piece.state.acceleration;
      state.velocity -= t * (state.acceleration + t * piece.jerk / 2);
      state.position -= t * (state.velocity + t * (state.acceleration / 2 + t * piece.jerk / 6));
      piece.state = state;
      sum += magnitude(state.velocity);
    }
  }

  // The acceleration goes to zero with `jerk` (a magnitude); then on at that velocity.
  void coast(const State<Real>& start, Real jerk) {
    begin(start, {start.position, start.velocity, 0});
    const Real duration_s = magnitude(start.acceleration) / jerk;
    if (duration_s > 0 && is_finite(duration_s)) {
      append({duration_s, start.acceleration, start.acceleration > 0 ? -jerk : jerk}, 1);
      end_ = {start.position + state_.position, state_.velocity, 0};
    }
    duration_s_ = elapsed_s_;
  }

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

  void append(const Phase<Real>& phase, Real scale) {
    state_.acceleration = scale * phase.acceleration;
    Piece& piece = pieces_[count_++];
    piece = {elapsed_s_, phase.duration_s, state_, scale * phase.jerk};
    state_ = advanced(state_, piece.jerk, phase.duration_s);
    elapsed_s_ += phase.duration_s;
  }

  // Where a walk through a signal stands: its phase, what is left of it, the acceleration there.
  // After its end a signal stays at its last acceleration: rounding may make the other one last
  // longer.
  struct Cursor {
    explicit Cursor(const Signal<Real>& of) : signal(of), rest(of.phase(0)) {}

    bool done() const { return index == signal.count(); }
    void spend(Real t) {
      if (done()) return;
      rest.acceleration += t * rest.jerk;
      rest.duration_s -= t;
      if (rest.duration_s > 0) return;
      if (++index < signal.count()) {
        rest = signal.phase(index);
      } else {
        rest.jerk = 0;
      }
    }

    const Signal<Real>& signal;
    int index = 0;
    Phase<Real> rest;
  };

  // Both signals merged, border by border. When both spend their longest phase in the middle, the
  // borders after it are counted back from the end: a difference of two times late in a long motion
  // would have lost the short phases there to rounding.
  void append_mixed(const Mix<Real>& mix, Real scale, Real duration_s) {
    const Split upper(mix.upper);
    const Split lower(mix.lower);
    const Real head_s = maximum(upper.head_s, lower.head_s);
    const Real tail_s = maximum(upper.tail_s, lower.tail_s);
    const Real middle_s = duration_s - head_s - tail_s;
    if (!upper.steady() || !lower.steady() || !(middle_s > 0)) {
      merge(mix.upper, mix.lower, mix.weight, scale);
      return;
    }
    merge(upper.head(head_s), lower.head(head_s), mix.weight, scale);
    append(mixed(upper.longest(), lower.longest(), mix.weight, middle_s), scale);
    merge(upper.tail(tail_s), lower.tail(tail_s), mix.weight, scale);
  }

  // A signal cut at its longest phase.
  struct Split {
    explicit Split(const Signal<Real>& whole) : signal(whole) {
      for (int i = 1; i < signal.count(); ++i) {
        if (signal.phase(i).duration_s > longest().duration_s) middle = i;
      }
      for (int i = 0; i < middle; ++i) head_s += signal.phase(i).duration_s;
      for (int i = middle + 1; i < signal.count(); ++i) tail_s += signal.phase(i).duration_s;
    }

    const Phase<Real>& longest() const { return signal.phase(middle); }
    bool steady() const { return longest().jerk == 0; }

    // The beginning, and the end, filled up to a length with the longest phase.
    Signal<Real> head(Real length_s) const {
      Signal<Real> part;
      for (int i = 0; i < middle; ++i) part.append(signal.phase(i));
      part.append({length_s - head_s, longest().acceleration, 0});
      return part;
    }
    Signal<Real> tail(Real length_s) const {
      Signal<Real> part;
      part.append({length_s - tail_s, longest().acceleration, 0});
      for (int i = middle + 1; i < signal.count(); ++i) part.append(signal.phase(i));
      return part;
    }

    const Signal<Real>& signal;
    int middle = 0;
    Real head_s = 0;
    Real tail_s = 0;
  };

  static Phase<Real> mixed(const Phase<Real>& upper, const Phase<Real>& lower, Real weight,
                           Real duration_s) {
    const Real rest = 1 - weight;
    return {duration_s, weight * upper.acceleration + rest * lower.acceleration,
            weight * upper.jerk + rest * lower.jerk};
  }

  void merge(const Signal<Real>& upper_signal, const Signal<Real>& lower_signal, Real weight,
             Real scale) {
    if (upper_signal.count() == 0 || lower_signal.count() == 0) return;
    Cursor upper(upper_signal);
    Cursor lower(lower_signal);
    while (!upper.done() || !lower.done()) {
      const Real step = upper.done()   ? lower.rest.duration_s
                        : lower.done() ? upper.rest.duration_s
                                       : minimum(upper.rest.duration_s, lower.rest.duration_s);
      append(mixed(upper.rest, lower.rest, weight, step), scale);
      upper.spend(step);
      lower.spend(step);
    }
  }

  std::array<Piece, kMaxPieces> pieces_;
  int count_ = 0;
  Real start_position_ = 0;
  Real duration_s_ = 0;
  Real brake_s_ = 0;
  State<Real> end_;
  // While building.
  State<Real> state_;
  Real elapsed_s_ = 0;
};

}  // namespace hoof::firmware::trajectory
