#pragma once

#include <CLI/CLI.hpp>

#include "tools/cli/invocation.h"

namespace hoof::tools {

// One function per command, each in a file of its own: adds the command to `app` and arranges
// that parsing it fills `invocation`.
void add_anova_command(CLI::App& app, Invocation& invocation);
void add_bed_command(CLI::App& app, Invocation& invocation);
void add_calibrate_command(CLI::App& app, Invocation& invocation);
void add_campaign_command(CLI::App& app, Invocation& invocation);
void add_claims_command(CLI::App& app, Invocation& invocation);
void add_compare_command(CLI::App& app, Invocation& invocation);
void add_conceal_command(CLI::App& app, Invocation& invocation);
void add_dbc_command(CLI::App& app, Invocation& invocation);
void add_design_command(CLI::App& app, Invocation& invocation);
void add_diagnose_command(CLI::App& app, Invocation& invocation);
void add_faults_command(CLI::App& app, Invocation& invocation);
void add_firmware_command(CLI::App& app, Invocation& invocation);
void add_log_command(CLI::App& app, Invocation& invocation);
void add_material_command(CLI::App& app, Invocation& invocation);
void add_order_command(CLI::App& app, Invocation& invocation);  // hoof command
void add_param_command(CLI::App& app, Invocation& invocation);
void add_replay_command(CLI::App& app, Invocation& invocation);
void add_reproduce_command(CLI::App& app, Invocation& invocation);
void add_report_command(CLI::App& app, Invocation& invocation);
void add_simulate_command(CLI::App& app, Invocation& invocation);
void add_sinkage_command(CLI::App& app, Invocation& invocation);
void add_study_command(CLI::App& app, Invocation& invocation);
void add_terrain_command(CLI::App& app, Invocation& invocation);
void add_traction_command(CLI::App& app, Invocation& invocation);
void add_version_command(CLI::App& app, Invocation& invocation);

}  // namespace hoof::tools
