#include "tools/bed/whole_file.h"

#include <system_error>
#include <utility>

#include "tools/run/errors.h"

namespace hoof::tools {

WholeFile::WholeFile(std::filesystem::path path)
    : path_(std::move(path)), part_(path_.string() + ".part") {}

WholeFile::~WholeFile() {
  std::error_code ignored;
  std::filesystem::remove(part_.path(), ignored);
}

void WholeFile::commit() {
  part_.close();
  std::error_code error;
  std::filesystem::rename(part_.path(), path_, error);
  if (error) throw UserError(path_.string() + ": cannot write: " + error.message());
}

}  // namespace hoof::tools
