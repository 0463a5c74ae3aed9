// Any bytes as a recording of somebody's: refused with one line that names the file, or read as a
// table whose rows are as wide as its head and whose numbers are finite or missing.
#include <cmath>
#include <cstdint>
#include <string>

#include "tests/fuzz/require.h"
#include "tools/diagnose/csv_table.h"
#include "tools/run/errors.h"

using namespace hoof::tools;
using hoof::tests::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  CsvTable table;
  try {
    table = parse_csv(text, "x.csv", {"t", "a", ""});
  } catch (const UserError& error) {
    const std::string what = error.what();
    require(what.starts_with("x.csv:"), "an error names the file");
    require(what.find('\n') == std::string::npos, "an error is one line");
    return 0;
  }
  require(table.columns.size() == table.names.size(), "each name has a column");
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const std::string& name = table.names[i];
    const bool wanted = name == "t" || name == "a" || name.empty();
    require(table.columns[i].size() == (wanted ? table.lines.size() : 0), "columns are whole");
    for (const double value : table.columns[i]) require(!std::isinf(value), "numbers are finite");
    require(name.empty() || table.find(name) == int(i), "names are different");
  }
  for (std::size_t i = 1; i < table.lines.size(); ++i) {
    require(table.lines[i] > table.lines[i - 1], "lines are in order");
  }
  return 0;
}
