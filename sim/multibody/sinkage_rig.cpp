#include "sim/multibody/sinkage_rig.h"

#include <sstream>
#include <stdexcept>

namespace hoof::sim {
namespace {

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

/// What rides on the carriage besides the foot.
MassProperties carriage(const SinkageRigSettings& settings) {
  settings.validate();
  MassProperties block;
  if (settings.load_as == LoadAs::kMass) {
    block.mass_kg = settings.load_N / kGravity_m_s2 - settings.foot.mass_kg;
  }
  return block;
}

}  // namespace

void SinkageRigSettings::validate() const {
  foot.validate();
  std::ostringstream text;
  if (!(load_N > 0.0)) {
    text << "load = " << load_N << " N: must be above 0";
  } else if (load_as == LoadAs::kMass && !(load_N > foot.mass_kg * kGravity_m_s2)) {
    text << "load = " << load_N << " N as a mass: must be above the weight of the foot, "
         << foot.mass_kg * kGravity_m_s2 << " N";
  }
  if (!text.str().empty()) throw std::invalid_argument(text.str());
}

SinkageRig::SinkageRig(const SinkageRigSettings& settings)
    : FootRig(settings.foot, carriage(settings),
              {kUp * settings.start_height_m, Eigen::Quaterniond::Identity()},
              Eigen::Vector3d::Zero()),
      slider_(world(), middle(), kUp),
      load_N_(settings.load_N) {
  hold();
}

void SinkageRig::hold() {
  slider_.drive(0.0);
  released_ = false;
}

void SinkageRig::lower(double speed_m_s) {
  slider_.drive(-speed_m_s);
  released_ = false;
}

void SinkageRig::release() {
  slider_.release();
  released_ = true;
}

void SinkageRig::step(double interval_s) {
  if (released_) middle().apply_force_at_com(-load_N_ * kUp);
  FootRig::step(interval_s);
}

}  // namespace hoof::sim
