// An update file: the image of each slot, header first, one behind the other.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/update/image_slot.h"

namespace hoof::bridge {

struct UpdateImage {
  firmware::update::ImageHeader header;
  std::vector<std::uint32_t> words;  // behind the header
};

struct UpdateFile {
  std::vector<UpdateImage> images;

  /// The one for a slot, or nothing.
  const UpdateImage* for_slot(std::size_t slot) const;
};

/// Checks what can be checked without the key. @throws std::runtime_error naming the file and what
/// is wrong with it: no update file, cut, damaged, for another board, or of another dictionary
/// than this program, which could not confirm it
UpdateFile read_update_file(const std::string& path);

}  // namespace hoof::bridge
