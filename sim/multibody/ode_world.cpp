#include "sim/multibody/ode_world.h"

#include <ode/ode.h>

#include <mutex>

namespace hoof::sim {
namespace {

static_assert(sizeof(dReal) == sizeof(double), "ODE must be built for double precision");

/// Share of a joint's position error corrected per step. At 50 microseconds any share is gone
/// within a millisecond; ODE's usual 0.2 keeps the correction's own speed small.
constexpr double kErrorReduction = 0.2;
/// Compliance of joints, (m/s) per N: 1000 N give way with 1 nm/s. Not zero, so that the solver's
/// matrix stays regular.
constexpr double kCompliance = 1e-12;

Eigen::Vector3d vector(const dReal* v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

OdeWorld::OdeWorld(const Eigen::Vector3d& gravity_m_s2) {
  // The library's global state is set up once and kept until the program ends.
  static std::once_flag once;
  std::call_once(once, [] { dInitODE2(0); });
  world_ = dWorldCreate();
  // The stepping jobs of a world are kept by its threading; the library's own is one for all
  // worlds, which two worlds stepped in two threads at once would tear.
  threading_ = dThreadingAllocateSelfThreadedImplementation();
  dWorldSetStepThreadingImplementation(world_, dThreadingImplementationGetFunctions(threading_),
                                       threading_);
  dWorldSetGravity(world_, gravity_m_s2.x(), gravity_m_s2.y(), gravity_m_s2.z());
  dWorldSetERP(world_, kErrorReduction);
  dWorldSetCFM(world_, kCompliance);
  dWorldSetAutoDisableFlag(world_, 0);
}

OdeWorld::~OdeWorld() {
  dWorldDestroy(world_);
  dThreadingFreeImplementation(threading_);
}

void OdeWorld::step(double interval_s) {
  dWorldStep(world_, interval_s);
}

OdeBody::OdeBody(OdeWorld& world, const MassProperties& mass, const Pose& pose)
    : body_(dBodyCreate(world.handle())), mass_(mass) {
  const Eigen::Matrix3d& i = mass.inertia_kg_m2;
  dMass ode_mass;
  dMassSetParameters(&ode_mass, mass.mass_kg, 0, 0, 0, i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2),
                     i(1, 2));
  dBodySetMass(body_, &ode_mass);
  const Eigen::Vector3d com = pose.p_WB_m + pose.q_WB * mass.com_B_m;
  dBodySetPosition(body_, com.x(), com.y(), com.z());
  const dQuaternion q = {pose.q_WB.w(), pose.q_WB.x(), pose.q_WB.y(), pose.q_WB.z()};
  dBodySetQuaternion(body_, q);
}

Pose OdeBody::pose() const {
  const dReal* q = dBodyGetQuaternion(body_);
  const Eigen::Quaterniond q_WB(q[0], q[1], q[2], q[3]);
  return {com_W_m() - q_WB * mass_.com_B_m, q_WB};
}

Eigen::Vector3d OdeBody::com_W_m() const {
  return vector(dBodyGetPosition(body_));
}

Eigen::Vector3d OdeBody::angular_velocity_rad_s() const {
  return vector(dBodyGetAngularVel(body_));
}

Eigen::Vector3d OdeBody::velocity_m_s() const {
  const Eigen::Vector3d origin_from_com = pose().p_WB_m - com_W_m();
  return vector(dBodyGetLinearVel(body_)) + angular_velocity_rad_s().cross(origin_from_com);
}

double OdeBody::kinetic_J() const {
  const Eigen::Vector3d v = vector(dBodyGetLinearVel(body_));
  const Eigen::Vector3d w_B = pose().q_WB.conjugate() * angular_velocity_rad_s();
  return 0.5 * (mass_.mass_kg * v.squaredNorm() + w_B.dot(mass_.inertia_kg_m2 * w_B));
}

void OdeBody::apply_force_at_com(const Eigen::Vector3d& f) {
  dBodyAddForce(body_, f.x(), f.y(), f.z());
}

void OdeBody::apply_torque(const Eigen::Vector3d& t) {
  dBodyAddTorque(body_, t.x(), t.y(), t.z());
}

void OdeBody::apply_wrench(const Wrench& wrench) {
  const Eigen::Vector3d origin_from_com = pose().p_WB_m - com_W_m();
  apply_force_at_com(wrench.f_W_N);
  apply_torque(wrench.tau_Bo_W_Nm + origin_from_com.cross(wrench.f_W_N));
}

void OdeBody::make_kinematic() {
  dBodySetKinematic(body_);
}

void OdeBody::move_kinematic(const Pose& target, double interval_s) {
  const Pose now = pose();
  const Eigen::Vector3d com = target.p_WB_m + target.q_WB * mass_.com_B_m;
  const Eigen::Vector3d v = (com - com_W_m()) / interval_s;
  const Eigen::AngleAxisd turn(target.q_WB * now.q_WB.conjugate());
  const Eigen::Vector3d w = turn.axis() * (turn.angle() / interval_s);
  dBodySetLinearVel(body_, v.x(), v.y(), v.z());
  dBodySetAngularVel(body_, w.x(), w.y(), w.z());
}

OdeHinge::OdeHinge(OdeWorld& world, OdeBody& moving, OdeBody* base,
                   const Eigen::Vector3d& anchor_W_m, const Eigen::Vector3d& axis_W,
                   double angle_rad)
    : joint_(dJointCreateHinge(world.handle(), nullptr)), offset_rad_(angle_rad) {
  dJointAttach(joint_, moving.handle(), base == nullptr ? nullptr : base->handle());
  dJointSetHingeAnchor(joint_, anchor_W_m.x(), anchor_W_m.y(), anchor_W_m.z());
  dJointSetHingeAxis(joint_, axis_W.x(), axis_W.y(), axis_W.z());
}

double OdeHinge::angle_rad() const {
  return offset_rad_ + dJointGetHingeAngle(joint_);
}

double OdeHinge::rate_rad_s() const {
  return dJointGetHingeAngleRate(joint_);
}

void OdeHinge::apply_torque(double torque_Nm) {
  dJointAddHingeTorque(joint_, torque_Nm);
}

void OdeHinge::set_stops(double min_rad, double max_rad) {
  // Set twice: ODE ignores a stop that lies beyond the other one's present value.
  for (int i = 0; i < 2; ++i) {
    dJointSetHingeParam(joint_, dParamLoStop, min_rad - offset_rad_);
    dJointSetHingeParam(joint_, dParamHiStop, max_rad - offset_rad_);
  }
  dJointSetHingeParam(joint_, dParamBounce, 0.0);
}

OdeSlider::OdeSlider(OdeWorld& world, OdeBody& moving, const Eigen::Vector3d& axis_W)
    : joint_(dJointCreateSlider(world.handle(), nullptr)) {
  dJointAttach(joint_, moving.handle(), nullptr);
  dJointSetSliderAxis(joint_, axis_W.x(), axis_W.y(), axis_W.z());
}

void OdeSlider::drive(double speed_m_s) {
  dJointSetSliderParam(joint_, dParamVel, speed_m_s);
  dJointSetSliderParam(joint_, dParamFMax, dInfinity);
}

void OdeSlider::release() {
  dJointSetSliderParam(joint_, dParamFMax, 0.0);
}

}  // namespace hoof::sim
