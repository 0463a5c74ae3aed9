#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

#include "tools/cli/commands.h"
#include "tools/design_of_experiments/design.h"
#include "tools/design_of_experiments/factor.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace {

struct DesignRequest {
  std::vector<std::string> factors;
  int centres = 5;
  unsigned long long seed = 1;
  bool in_order = false, within = false;
  std::filesystem::path out;
};

std::string csv_of(const Design& design, const std::vector<Factor>& factors,
                   const DesignRequest& request) {
  std::string text = "run";
  for (const Factor& f : factors) text += "," + f.name;
  text += "\n";
  std::vector<int> order = run_order(static_cast<int>(design.size()), request.seed);
  if (request.in_order) {
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  }
  for (std::size_t i = 0; i < order.size(); ++i) {
    text += std::to_string(i + 1);
    for (std::size_t f = 0; f < factors.size(); ++f) {
      char cell[40];
      const double coded = design[static_cast<std::size_t>(order[i])][f];
      std::snprintf(cell, sizeof cell, ",%.9g", factors[f].value(coded));
      text += cell;
    }
    text += "\n";
  }
  return text;
}

/// A coefficient that may not be below nothing can come out so.
void warn_of_axial_runs(const std::vector<Factor>& factors, double axis) {
  std::cerr << "axial runs go beyond the bounds, to";
  for (const Factor& f : factors) {
    char text[80];
    std::snprintf(text, sizeof text, " %.4g and %.4g", f.value(-axis), f.value(axis));
    std::cerr << (&f == &factors.front() ? " " : ", ") << f.name << text;
  }
  std::cerr << "; --within keeps them inside\n";
}

void run(const DesignRequest& request, bool box) {
  std::vector<Factor> factors;
  for (const std::string& text : request.factors) {
    factors.push_back(parse_factor(text));
    for (std::size_t i = 0; i + 1 < factors.size(); ++i) {
      if (factors[i].name == factors.back().name) {
        throw UserError("--factor " + text + ": " + factors.back().name + " is there already");
      }
    }
  }
  const auto count = static_cast<int>(factors.size());
  const int low = box ? 3 : 2, high = box ? 5 : 6;
  if (count < low || count > high) {
    throw UserError("--factor: " + std::to_string(count) + " factors; this design has " +
                    std::to_string(low) + " to " + std::to_string(high));
  }
  const double axis = request.within ? 1 : rotatable_axis(count);
  const Design design =
      box ? box_behnken(count, request.centres) : central_composite(count, request.centres, axis);
  if (!box && !request.within) warn_of_axial_runs(factors, axis);
  const std::string text = csv_of(design, factors, request);
  if (request.out.empty()) {
    std::cout << text;
  } else {
    write_file(request.out, text);
    std::cout << design.size() << " runs in " << request.out.string() << "\n";
  }
}

void add_design(CLI::App& parent, Invocation& invocation, const char* name, const char* help,
                bool box) {
  auto request = std::make_shared<DesignRequest>();
  CLI::App* command = parent.add_subcommand(name, help);
  command->add_option("--factor", request->factors, "What is varied, once for each")
      ->type_name("NAME=LOW:HIGH")
      ->required()
      ->allow_extra_args(false);
  command->add_option("--centres", request->centres, "Runs in the middle of all, 0..100")
      ->type_name("N")
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
  command->add_option("--seed", request->seed, "Of the random order of the runs")
      ->type_name("S")
      ->capture_default_str();
  command->add_flag("--in-order", request->in_order, "Not in a random order");
  if (!box) {
    command->add_flag("--within", request->within,
                      "Axial runs at the bounds (face-centred), not beyond them (rotatable)");
  }
  command->add_option("--out", request->out, "File [standard output]")->type_name("FILE.csv");
  command->footer(
      std::string("Add a column with what came out, and give the file to hoof anova.\nExample:\n") +
      "  hoof design " + name + " --factor e=0.1:0.8 --factor mu_r=0.1:0.4 --factor mu_s=0.2:0.9" +
      (box ? "" : " --within") + " --out plan.csv");
  command->callback(
      [&invocation, request, box] { invocation.run = [request, box] { run(*request, box); }; });
}

}  // namespace

void add_design_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("design", "Which runs to make for a response surface");
  command->require_subcommand(1);
  add_design(*command, invocation, "box-behnken",
             "Pairs of factors at their corners, the others in the middle; 3 to 5 factors", true);
  add_design(*command, invocation, "central-composite",
             "All corners, axes and the middle; 2 to 6 factors", false);
  command->footer(
      "Example:\n"
      "  hoof design box-behnken --factor e=0.1:0.8 --factor mu_r=0.1:0.4 --factor mu_s=0.2:0.9");
}

}  // namespace hoof::tools
