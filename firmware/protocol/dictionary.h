// The message dictionary: every frame on both buses, once. Codecs, hoof.dbc, the protocol hash and
// the worst-case bus load are all computed from the tables in this file; scale factors exist here
// and nowhere else.
#pragma once

#include <array>
#include <cstddef>

#include "firmware/protocol/drive_ranges.h"
#include "firmware/protocol/signal.h"

namespace hoof::firmware::protocol {

// ---- named values -------------------------------------------------------------------------------

inline constexpr ValueName kModeNames[] = {{0, "off"},     {1, "homing"},      {2, "ready"},
                                           {3, "running"}, {4, "damped_stop"}, {5, "emergency_off"},
                                           {6, "fault"}};

inline constexpr ValueName kOrderNames[] = {
    {0, "stop"}, {1, "ready"}, {2, "run"}, {3, "reset"}, {4, "release"}};

inline constexpr ValueName kOrderResultNames[] = {
    {0, "accepted"},      {1, "bad_crc"},          {2, "bad_counter"},     {3, "not_owner"},
    {4, "unknown_order"}, {5, "out_of_range"},     {6, "wrong_mode"},      {7, "no_leg"},
    {8, "not_connected"}, {9, "other_dictionary"}, {10, "not_calibrated"}, {11, "no_sync"}};

/// Error byte of the AK family's reply.
inline constexpr ValueName kDriveErrorNames[] = {{0, "none"},
                                                 {1, "motor_over_temperature"},
                                                 {2, "over_current"},
                                                 {3, "over_voltage"},
                                                 {4, "under_voltage"},
                                                 {5, "encoder"},
                                                 {6, "mosfet_over_temperature"},
                                                 {7, "motor_stalled"}};

/// Bits of `faults` in the heartbeat. Ranges: 0-3 communication, 4-8 drives, 9-13 motion, 14-17
/// orders and the firmware itself, 18-19 the board.
inline constexpr ValueName kFaultBitNames[] = {
    {0, "sync_lost"},         {1, "drive_lost"},        {2, "bus_off"},
    {4, "drive_error"},       {5, "implausible_reply"}, {6, "over_temperature"},
    {7, "overload"},          {8, "not_following"},     {9, "homing_failed"},
    {10, "toe_jammed"},       {11, "toe_stalled"},      {12, "outside_travel"},
    {13, "path_unreachable"}, {14, "emergency_stop"},   {15, "invalid_wish"},
    {16, "overrun"},          {17, "storage"},          {18, "brown_out"},
    {19, "unexpected_reset"}};

/// Bits of the three joints' limits in FootGate.
inline constexpr ValueName kLimitBitNames[] = {{0, "torque"},  {1, "torque_rate"}, {2, "distance"},
                                               {3, "travel"},  {4, "velocity"},    {5, "gain"},
                                               {6, "refused"}, {7, "latched"},     {8, "overload"}};

/// What a ServiceRequest asks for.
inline constexpr ValueName kServiceNames[] = {{0, "read_parameter"},     {1, "store_parameters"},
                                              {2, "default_parameters"}, {3, "calibrate_zero"},
                                              {4, "read_status"},        {5, "read_fault_log"},
                                              {6, "erase_fault_log"},    {7, "write_parameter"}};

inline constexpr ValueName kServiceResultNames[] = {
    {0, "done"},          {1, "bad_counter"},   {2, "not_owner"},   {3, "unknown_service"},
    {4, "no_such_index"}, {5, "out_of_range"},  {6, "wrong_mode"},  {7, "flash_failed"},
    {8, "busy"},          {9, "nothing_there"}, {10, "no_storage"}, {11, "not_connected"}};

/// `index` of the service read_status.
inline constexpr ValueName kStatusNames[] = {{0, "parameter_count"},  {1, "parameter_table_hash"},
                                             {2, "stored_sequence"},  {3, "load_result"},
                                             {4, "log_state"},        {5, "log_used"},
                                             {6, "log_capacity"},     {7, "log_lost"},
                                             {8, "reset_cause"},      {9, "words_per_record"},
                                             {10, "image_slot"},      {11, "image_version"},
                                             {12, "image_on_trial"},  {13, "image_healthy"},
                                             {14, "spare_version"},   {15, "spare_refusal"},
                                             {16, "update_state"},    {17, "update_next_word"},
                                             {18, "update_checksum"}, {19, "update_version"},
                                             {20, "update_problem"}};

// ---- signals ------------------------------------------------------------------------------------

inline constexpr Signal kEmergencyStopSignals[] = {
    number("source", 0, 8, "Who pressed; the stop acts on the identifier alone, whatever follows"),
    number("counter", 8, 8, "Of the button's frames"), number("crc", 16, 8, "CRC-8")};

inline constexpr Signal kSyncSignals[] = {
    number("tick", 0, 32, "Number of the control tick; one millisecond of control time each")};

constexpr std::array<Signal, 5> command_signals(const DriveRange& r) {
  return {spread("position_rad", 0, 16, -r.position_rad, r.position_rad, "rad", "Desired angle"),
          spread("velocity_rad_s", 16, 12, -r.velocity_rad_s, r.velocity_rad_s, "rad/s",
                 "Desired speed"),
          spread("kp_Nm_rad", 28, 12, 0.0f, r.kp_Nm_rad, "Nm/rad", "Stiffness"),
          spread("kd_Nm_s_rad", 40, 12, 0.0f, r.kd_Nm_s_rad, "Nm s/rad", "Damping"),
          spread("torque_Nm", 52, 12, -r.torque_Nm, r.torque_Nm, "Nm",
                 "Feed-forward; an even number of codes, so no code is exactly zero")};
}

constexpr std::array<Signal, 6> reply_signals(const DriveRange& r) {
  return {number("drive_id", 0, 8, "1 toe, 2 hip, 3 knee"),
          spread("position_rad", 8, 16, -r.position_rad, r.position_rad, "rad", "Measured angle"),
          spread("velocity_rad_s", 24, 12, -r.velocity_rad_s, r.velocity_rad_s, "rad/s",
                 "Measured speed"),
          spread("torque_Nm", 36, 12, -r.torque_Nm, r.torque_Nm, "Nm", "Torque by motor current"),
          stepped("temperature_C", 48, 8, 1.0f, -40.0f, "degC", "Motor winding"),
          number("error", 56, 8, "Drive fault code", kDriveErrorNames)};
}

inline constexpr std::array<std::array<Signal, 5>, kDriveCount> kCommandSignals{
    command_signals(kDriveRanges[0]), command_signals(kDriveRanges[1]),
    command_signals(kDriveRanges[2])};
inline constexpr std::array<std::array<Signal, 6>, kDriveCount> kReplySignals{
    reply_signals(kDriveRanges[0]), reply_signals(kDriveRanges[1]), reply_signals(kDriveRanges[2])};

inline constexpr Signal kSupervisorOrderSignals[] = {
    number("supervisor_id", 0, 8, "Who orders, 1 to 255; 0 is nobody and refused"),
    number("order", 8, 8, "What to do", kOrderNames),
    stepped("toe_angle_rad", 16, 16, 1e-4f, 0.0f, "rad", "Opening angle of each toe"),
    stepped("frequency_Hz", 32, 16, 1e-3f, 0.0f, "Hz", "Cycles of the stance path per second"),
    number("counter", 48, 8, "Must be the expected one, told in every acknowledge"),
    number("crc", 56, 8, "CRC-8")};

inline constexpr Signal kOrderAcknowledgeSignals[] = {
    number("supervisor_id", 0, 8, "Whose order is answered"),
    number("counter", 8, 8, "Counter of the order answered"),
    number("result", 16, 8, "What became of it", kOrderResultNames),
    number("mode", 24, 8, "Mode at that moment", kModeNames),
    number("expected_counter", 32, 8, "Counter that the next order must carry"),
    number("owner_id", 40, 8, "Supervisor that owns the foot; 0 nobody"),
    number("reserved", 48, 8, "0"),
    number("crc", 56, 8, "CRC-8")};

inline constexpr Signal kSupervisorConnectSignals[] = {
    number("supervisor_id", 0, 8, "Who connects, 1 to 255"),
    number("protocol_hash", 8, 32, "Hash of the supervisor's dictionary; another one is refused"),
    number("counter", 40, 8, "Echoed in the acknowledge; free"), number("reserved", 48, 8, "0"),
    number("crc", 56, 8, "CRC-8")};

inline constexpr Signal kParameterWriteSignals[] = {
    number("supervisor_id", 0, 8, "Who writes; must own the foot, or nobody may"),
    number("index", 8, 8, "Place in the parameter table; from 224 on part of a firmware update"),
    number("value", 16, 32, "IEEE 754 binary32; of an update a word"),
    number("counter", 48, 8, "Must be the expected one, as of an order"),
    number("crc", 56, 8, "CRC-8")};

inline constexpr Signal kServiceRequestSignals[] = {
    number("supervisor_id", 0, 8, "Who asks, 1 to 255"),
    number("service", 8, 8, "What for", kServiceNames),
    number("index", 16, 8, "Parameter, joint, status or record"),
    number("offset", 24, 16, "Word of the record"),
    number("reserved", 40, 8, "0"),
    number("counter", 48, 8, "Expected one for what changes something; else free, echoed"),
    number("crc", 56, 8, "CRC-8")};

inline constexpr Signal kServiceAnswerSignals[] = {
    number("service", 0, 4, "What was asked for", kServiceNames),
    number("result", 4, 4, "What became of it", kServiceResultNames),
    number("index", 8, 8, "Of the request"),
    number("counter", 16, 8, "Of the request"),
    number("value", 24, 32, "Answer; where the result is bad_counter, the expected one"),
    number("crc", 56, 8, "CRC-8")};

inline constexpr Signal kHeartbeatSignals[] = {
    number("mode", 0, 4, "Mode", kModeNames), number("counter", 4, 4, "Of heartbeats"),
    number("faults", 8, 24, "OR of all latched faults, a bit each (kFaultBitNames)"),
    number("protocol_hash", 32, 24, "Low 24 bits of this dictionary's hash; others: do not talk"),
    number("crc", 56, 8, "CRC-8")};

inline constexpr Signal kFootToeSignals[] = {
    stepped("commanded_rad", 0, 16, 1e-4f, -3.0f, "rad", "Opening angle ordered now"),
    stepped("measured_rad", 16, 16, 1e-4f, -3.0f, "rad", "Opening angle measured"),
    stepped("torque_Nm", 32, 16, 1e-3f, -32.768f, "Nm", "Toe drive torque measured"),
    stepped("temperature_C", 48, 8, 1.0f, -40.0f, "degC", "Toe drive"),
    number("moving", 56, 8, "1 while a move is under way")};

inline constexpr Signal kFootLegSignals[] = {
    stepped("hip_rad", 0, 16, 1e-4f, -3.2768f, "rad", "Thigh from straight down, forward +"),
    stepped("knee_rad", 16, 16, 1e-4f, -3.2768f, "rad", "Shank against thigh, forward +"),
    stepped("foot_x_m", 32, 16, 1e-4f, -3.2768f, "m", "Sole point ahead of the hip"),
    stepped("foot_z_m", 48, 16, 1e-4f, -3.2768f, "m", "Sole point above the level sand")};

inline constexpr Signal kFootGroundSignals[] = {
    stepped("phase_cycles", 0, 16, 1.0f / 65536.0f, 0.0f, "", "Place on the stance path"),
    stepped("sinkage_m", 16, 16, 1e-5f, 0.0f, "m", "Estimate: depth below the touch-down height"),
    stepped("force_x_N", 32, 12, 1.0f, -2048.0f, "N", "Estimate: sand on foot, forward +"),
    stepped("force_z_N", 44, 12, 1.0f, -1024.0f, "N", "Estimate: sand on foot, up +"),
    number("contact", 56, 8, "1 while the foot touches")};

inline constexpr Signal kFootGateSignals[] = {
    number("interventions", 0, 28, "Joint commands changed or refused by the gate since start"),
    number("toe_limits", 28, 12, "Why, now (kLimitBitNames)"),
    number("hip_limits", 40, 12, "Why, now (kLimitBitNames)"),
    number("knee_limits", 52, 12, "Why, now (kLimitBitNames)")};

inline constexpr Signal kFootCountersSignals[] = {
    number("ticks", 0, 32, "Control ticks since start"),
    number("missed_ticks", 32, 16, "SYNC numbers that never came, modulo 65536"),
    number("stale_syncs", 48, 16, "Repeated or older SYNC numbers, modulo 65536")};

inline constexpr Signal kFootLoadSignals[] = {
    stepped("toe_heat_ratio", 0, 8, 0.005f, 0.0f, "", "Winding's heat over what it bears for ever"),
    stepped("hip_heat_ratio", 8, 8, 0.005f, 0.0f, "", "As toe_heat_ratio"),
    stepped("knee_heat_ratio", 16, 8, 0.005f, 0.0f, "", "As toe_heat_ratio"),
    stepped("slip_m", 24, 16, 1e-4f, -3.2768f, "m",
            "Estimate: the sole's way back since touch-down"),
    stepped("slip_ratio", 40, 8, 0.01f, -1.28f, "", "Estimate: 1 - body speed / sole speed"),
    stepped("supply_V", 48, 8, 0.25f, 0.0f, "V", "Supply of board and drives; 0 not measured"),
    number("overruns", 56, 8, "Ticks that took longer than a tick, modulo 256")};

inline constexpr Signal kFootFramesSignals[] = {
    number("unknown", 0, 16, "Identifier not ours, or on the wrong bus, modulo 65536"),
    number("malformed", 16, 16, "Short, long, extended, remote, FD, error, modulo 65536"),
    number("bad_crc", 32, 16, "Modulo 65536"),
    number("refused", 48, 16, "Orders and services refused, replayed ones too, modulo 65536")};

// ---- messages -----------------------------------------------------------------------------------

/// Position of each message in `kMessages`.
enum class Message : std::uint8_t {
  kEmergencyStop = 0,
  kSync,
  kToeCommand,
  kHipCommand,
  kKneeCommand,
  kToeReply,
  kHipReply,
  kKneeReply,
  kSupervisorOrder,
  kOrderAcknowledge,
  kSupervisorConnect,
  kParameterWrite,
  kServiceRequest,
  kServiceAnswer,
  kHeartbeat,
  kFootToe,
  kFootLeg,
  kFootGround,
  kFootGate,
  kFootCounters,
  kFootLoad,
  kFootFrames,
};

inline constexpr auto kMessages = std::to_array<MessageSpec>({
    {"EmergencyStop", 0x001, 3, true, 0, 10, Node::kEstopButton, Node::kFoot, kBus0,
     kEmergencyStopSignals, "Torque off at once; highest priority; cleared by the reset order"},
    {"Sync", 0x010, 4, false, 1, 1, Node::kSyncMaster, Node::kFoot, kBus0 | kBus1, kSyncSignals,
     "Runs one control tick"},
    {"ToeCommand", 0x021, 8, false, 1, 1, Node::kFoot, Node::kToeDrive, kBus0, kCommandSignals[0],
     "FF FF FF FF FF FF FF and FC, FD or FE: enter, exit, set zero"},
    {"HipCommand", 0x022, 8, false, 1, 1, Node::kFoot, Node::kHipDrive, kBus1, kCommandSignals[1],
     "As ToeCommand"},
    {"KneeCommand", 0x023, 8, false, 1, 1, Node::kFoot, Node::kKneeDrive, kBus1, kCommandSignals[2],
     "As ToeCommand"},
    {"ToeReply", 0x031, 8, false, 1, 1, Node::kToeDrive, Node::kFoot, kBus0, kReplySignals[0],
     "State of the drive when the command arrived"},
    {"HipReply", 0x032, 8, false, 1, 1, Node::kHipDrive, Node::kFoot, kBus1, kReplySignals[1],
     "As ToeReply"},
    {"KneeReply", 0x033, 8, false, 1, 1, Node::kKneeDrive, Node::kFoot, kBus1, kReplySignals[2],
     "As ToeReply"},
    {"SupervisorOrder", 0x040, 8, true, 0, 10, Node::kSupervisor, Node::kFoot, kBus0,
     kSupervisorOrderSignals, "Mode, toe angle and gait; owned by one supervisor at a time"},
    {"OrderAcknowledge", 0x041, 8, true, 0, 10, Node::kFoot, Node::kSupervisor, kBus0,
     kOrderAcknowledgeSignals, "Answers every order frame"},
    {"SupervisorConnect", 0x042, 8, true, 0, 10, Node::kSupervisor, Node::kFoot, kBus0,
     kSupervisorConnectSignals, "Before the first order; answered by OrderAcknowledge"},
    {"ParameterWrite", 0x043, 8, true, 0, 2, Node::kSupervisor, Node::kFoot, kBus0,
     kParameterWriteSignals, "In mode off only; answered by ServiceAnswer"},
    {"ServiceRequest", 0x044, 8, true, 0, 10, Node::kSupervisor, Node::kFoot, kBus0,
     kServiceRequestSignals, "Parameters, calibration, fault log; answered by ServiceAnswer"},
    {"ServiceAnswer", 0x045, 8, true, 0, 2, Node::kFoot, Node::kSupervisor, kBus0,
     kServiceAnswerSignals, "Answers every ServiceRequest and ParameterWrite"},
    {"Heartbeat", 0x050, 8, true, 100, 10, Node::kFoot, Node::kSupervisor, kBus0, kHeartbeatSignals,
     "At 10 Hz and on change"},
    {"FootToe", 0x060, 8, false, 10, 10, Node::kFoot, Node::kSupervisor, kBus0, kFootToeSignals,
     "Toe opening"},
    {"FootLeg", 0x061, 8, false, 10, 10, Node::kFoot, Node::kSupervisor, kBus0, kFootLegSignals,
     "Leg posture"},
    {"FootGround", 0x062, 8, false, 10, 10, Node::kFoot, Node::kSupervisor, kBus0,
     kFootGroundSignals, "Gait and what the leg feels of the sand"},
    {"FootGate", 0x063, 8, false, 10, 10, Node::kFoot, Node::kSupervisor, kBus0, kFootGateSignals,
     "What the torque gate changed"},
    {"FootCounters", 0x064, 8, false, 100, 100, Node::kFoot, Node::kSupervisor, kBus0,
     kFootCountersSignals, "Counters of the control loop"},
    {"FootLoad", 0x065, 8, false, 10, 10, Node::kFoot, Node::kSupervisor, kBus0, kFootLoadSignals,
     "Heat of the windings, slip, supply"},
    {"FootFrames", 0x066, 8, false, 100, 100, Node::kFoot, Node::kSupervisor, kBus0,
     kFootFramesSignals, "Frames that were not acted upon"},
});

constexpr const MessageSpec& spec(Message message) {
  return kMessages[static_cast<std::size_t>(message)];
}
constexpr const MessageSpec& command_spec(Drive drive) {
  return kMessages[static_cast<std::size_t>(Message::kToeCommand) + index(drive)];
}
constexpr const MessageSpec& reply_spec(Drive drive) {
  return kMessages[static_cast<std::size_t>(Message::kToeReply) + index(drive)];
}

}  // namespace hoof::firmware::protocol
