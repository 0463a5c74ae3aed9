#include "sim/coupling/plant.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace hoof::sim {
namespace {

/// Work of a wrench while its body moves: force times way of the origin, torque times turn.
double work_J(const Wrench& wrench, const BodyMotion& motion) {
  // In the air, most of the time: the turn is not worth its arc tangent.
  if (wrench.f_W_N.isZero(0) && wrench.tau_Bo_W_Nm.isZero(0)) return 0;
  const Eigen::AngleAxisd turn(motion.end.q_WB * motion.start.q_WB.conjugate());
  return wrench.f_W_N.dot(motion.end.p_WB_m - motion.start.p_WB_m) +
         wrench.tau_Bo_W_Nm.dot(turn.axis() * turn.angle());
}

}  // namespace

Plant::Plant(std::unique_ptr<Rig> rig, const DriveSet& drives, std::unique_ptr<Terrain> terrain,
             const CouplingSettings& settings)
    : rig_(std::move(rig)), terrain_(std::move(terrain)), settings_(settings) {
  settings_.validate();
  for (const Joint joint : rig_->joints()) {
    const int index = static_cast<int>(joint);
    if (drives[index]) drives_[index].emplace(*drives[index], rig_->joint_position_rad(joint));
  }
  for (int body = 0; body < rig_->body_count(); ++body) {
    const Pose pose = rig_->pose(body);
    terrain_->add_body(rig_->mesh(body), pose);
    motions_.push_back({pose, pose});
    double reach_m = 0;
    for (const auto& vertex : rig_->mesh(body).vertices_m) {
      reach_m = std::max(reach_m, vertex.norm());
    }
    reach_m_.push_back(reach_m);
  }
  wrenches_.resize(motions_.size());
  before_.resize(motions_.size());
}

Drive* Plant::drive(Joint joint) {
  auto& drive = drives_[static_cast<int>(joint)];
  return drive ? &*drive : nullptr;
}

const Drive* Plant::drive(Joint joint) const {
  const auto& drive = drives_[static_cast<int>(joint)];
  return drive ? &*drive : nullptr;
}

Eigen::Vector3d Plant::ground_force_N() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Wrench& wrench : wrenches_) sum += wrench.f_W_N;
  return sum;
}

void Plant::advance() {
  step_drives();
  step_rig();
  step_terrain();
  ++intervals_;
  guard();
}

void Plant::step_drives() {
  for (const Joint joint : rig_->joints()) {
    Drive* const motor = drive(joint);
    if (motor == nullptr) continue;
    const double torque_Nm = motor->step(settings_.exchange_s, rig_->joint_position_rad(joint),
                                         rig_->joint_velocity_rad_s(joint));
    torques_Nm_[static_cast<int>(joint)] = torque_Nm;
    rig_->apply_joint_torque(joint, torque_Nm);
  }
}

/// The ground's wrench for the interval to come. The mean of the last interval belongs to its
/// middle; used as it stands it would reach the rig one interval late and act like a damper of -k h
/// / 2, which makes energy. Carried on to the end of the last interval along the line through the
/// last two means it is as prompt as that of a ground that answers at the end; sums over time stay
/// the same.
Wrench Plant::prompt_wrench(std::size_t body) const {
  const Wrench& now = wrenches_[body];
  if (terrain_->wrench_time() == WrenchTime::kEndOfInterval) return now;
  const Wrench& before = before_[body];
  return {1.5 * now.f_W_N - 0.5 * before.f_W_N, 1.5 * now.tau_Bo_W_Nm - 0.5 * before.tau_Bo_W_Nm};
}

void Plant::step_rig() {
  for (std::size_t body = 0; body < motions_.size(); ++body) {
    rig_->apply_wrench(static_cast<int>(body), prompt_wrench(body));
  }
  rig_->step(settings_.exchange_s);
  for (std::size_t body = 0; body < motions_.size(); ++body) {
    BodyMotion& motion = motions_[body];
    const BodyMotion before = motion;
    const Wrench wrench = prompt_wrench(body);
    motion = {before.end, rig_->pose(static_cast<int>(body))};
    // A force held for a step changes the velocity from that of the way before to that of the way
    // now; the energy it gives is force times the mean of both.
    exchange_energy_.work_on_rig_J += 0.5 * (work_J(wrench, before) + work_J(wrench, motion));
  }
}

void Plant::step_terrain() {
  if (asleep_) {
    const double wakes_at_m = terrain_->surface_height_m() + settings_.sleep_margin_m;
    asleep_ = far_above_m(wakes_at_m) || lowest_point_m() > wakes_at_m;
    if (asleep_) return;
  }
  before_ = wrenches_;
  terrain_->advance(settings_.exchange_s, motions_, wrenches_);
  exchange_energy_.work_by_terrain_J = terrain_->work_on_bodies_J();
  touched_ = touched_ || std::any_of(wrenches_.begin(), wrenches_.end(), [](const Wrench& wrench) {
               return wrench.f_W_N.squaredNorm() > 0.0;
             });
}

/// However the bodies are turned. Spares the look at every vertex.
bool Plant::far_above_m(double height_m) const {
  constexpr double kRounding_m = 1e-6;
  for (std::size_t body = 0; body < motions_.size(); ++body) {
    if (!(motions_[body].end.p_WB_m.z() - reach_m_[body] > height_m + kRounding_m)) return false;
  }
  return true;
}

double Plant::lowest_point_m() const {
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t body = 0; body < motions_.size(); ++body) {
    const Pose& pose = motions_[body].end;
    const Eigen::Matrix3d R_WB = pose.q_WB.toRotationMatrix();
    for (const Eigen::Vector3d& vertex : rig_->mesh(static_cast<int>(body)).vertices_m) {
      lowest = std::min(lowest, pose.p_WB_m.z() + R_WB.row(2).dot(vertex));
    }
  }
  return lowest;
}

/// Called every interval: costs next to nothing while all is well.
void Plant::guard() const {
  const double speed_m_s = rig_->foot_velocity_m_s().norm();
  const Eigen::Vector3d force_N = ground_force_N();
  // Written so that NaN breaks each rule.
  if (!force_N.allFinite()) {
    diverged("the force of the ground is not a number");
  }
  if (!(speed_m_s <= settings_.speed_limit_m_s)) {
    std::ostringstream cause;
    cause << "the foot moves at " << speed_m_s
          << " m/s, above coupling.speed_limit_m_s = " << settings_.speed_limit_m_s;
    diverged(cause.str());
  }
  if (!(exchange_energy_.error_J() <= settings_.energy_error_limit_J)) {
    std::ostringstream cause;
    cause << "the exchange has made " << exchange_energy_.error_J()
          << " J, above coupling.energy_error_limit_J = " << settings_.energy_error_limit_J;
    diverged(cause.str());
  }
}

void Plant::diverged(const std::string& cause) const {
  std::ostringstream text;
  text << "diverged at " << time_s() << " s: " << cause << "; shorten coupling.exchange_us (now "
       << settings_.exchange_s * 1e6 << ") or make the foot heavier";
  throw std::runtime_error(text.str());
}

}  // namespace hoof::sim
