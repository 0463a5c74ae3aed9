#include "hil_bridge/update_file.h"

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "firmware/app/crc32.h"
#include "firmware/protocol/protocol_hash.h"

namespace hoof::bridge {

using namespace firmware::update;

namespace {

constexpr std::size_t kSlotWords = 128 * 1024 / 4;

std::vector<std::uint32_t> read_words(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    throw std::runtime_error(path + ": cannot be opened; hoof firmware build makes an update file");
  }
  const std::vector<char> bytes(std::istreambuf_iterator<char>(in), {});
  std::vector<std::uint32_t> words(bytes.size() / 4);
  for (std::size_t i = 0; i < 4 * words.size(); ++i) {
    words[i / 4] |= std::uint32_t(std::uint8_t(bytes[i])) << (8 * (i % 4));
  }
  return words;
}

UpdateImage take_image(const std::string& path, const std::vector<std::uint32_t>& words,
                       std::size_t& at) {
  UpdateImage image;
  const std::size_t left = words.size() - at;
  const auto begin = words.begin() + std::ptrdiff_t(at);
  if (left >= kHeaderWords) {
    std::copy(begin, begin + ImageHeader::kWords, image.header.word.begin());
  }
  const ImageHeader& header = image.header;
  const Problem problem = examine(header, kFootBoard, header.slot() % kSlots, kSlotWords);
  if (problem == Problem::kOtherBoard) throw std::runtime_error(path + ": is for another board");
  if (problem != Problem::kNone) throw std::runtime_error(path + ": is no update file");
  const std::size_t size = header.bytes() / 4;
  if (left - kHeaderWords < size) {
    throw std::runtime_error(path + ": ends within an image; was it copied whole?");
  }
  image.words.assign(begin + kHeaderWords, begin + std::ptrdiff_t(kHeaderWords + size));
  if (firmware::app::Crc32().add(image.words).value() != header.crc()) {
    throw std::runtime_error(path + ": damaged, its checksum is not that of its image");
  }
  if (header.protocol_hash() != firmware::protocol::kProtocolHash) {
    throw std::runtime_error(path +
                             ": speaks another dictionary than this program, which could not "
                             "confirm it; use the hoof that it was built with");
  }
  at += kHeaderWords + size;
  return image;
}

}  // namespace

const UpdateImage* UpdateFile::for_slot(std::size_t slot) const {
  for (const UpdateImage& image : images) {
    if (image.header.slot() == slot) return &image;
  }
  return nullptr;
}

UpdateFile read_update_file(const std::string& path) {
  const std::vector<std::uint32_t> words = read_words(path);
  UpdateFile file;
  std::size_t at = 0;
  do {
    file.images.push_back(take_image(path, words, at));
  } while (at < words.size());
  return file;
}

}  // namespace hoof::bridge
