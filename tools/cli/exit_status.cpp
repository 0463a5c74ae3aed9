#include "tools/cli/exit_status.h"

#include <cstdlib>
#include <exception>
#include <iostream>
#include <stdexcept>

#include "sim/config/config_error.h"
#include "tools/run/differs.h"

namespace hoof::tools {
namespace {

void say(const std::string& program, std::string message) {
  // Some libraries break their messages over lines; the user gets one.
  for (char& c : message) {
    if (c == '\n') c = ' ';
  }
  std::cerr << program << ": " << message << std::endl;
}

}  // namespace

int complain(const std::string& program, std::string message, ExitStatus status) {
  say(program, std::move(message));
  return static_cast<int>(status);
}

int run_to_status(const std::string& program, const std::function<void()>& run) {
  try {
    run();
    return EXIT_SUCCESS;
  } catch (const AlreadySaid& failed) {
    return failed.exit_status();
  } catch (const Interrupted& stop) {
    say(program, stop.what());
    return stop.exit_status();
  } catch (const Differs& result) {
    std::cout << result.what() << std::endl;
    return Differs::kExitStatus;
  } catch (const BarMissed& error) {
    return complain(program, error.what(), static_cast<ExitStatus>(EXIT_FAILURE));
  } catch (const UserError& error) {
    return complain(program, error.what(), ExitStatus::kUserError);
  } catch (const sim::ConfigError& error) {
    return complain(program, error.what(), ExitStatus::kUserError);
  } catch (const std::invalid_argument& error) {
    // Settings that are possible one by one but not together.
    return complain(program, error.what(), ExitStatus::kUserError);
  } catch (const std::exception& error) {
    return complain(program, error.what(), ExitStatus::kCannotFinish);
  }
}

}  // namespace hoof::tools
