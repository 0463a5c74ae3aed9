// Brings a new image to a foot, word by word, and sees it through its trial.
#pragma once

#include <functional>

#include "hil_bridge/service_client.h"
#include "hil_bridge/update_file.h"

namespace hoof::bridge {

/// What the foot says of its images.
struct ImageStatus {
  std::size_t slot = 0;  // that runs
  std::uint32_t version = 0;
  bool on_trial = false;
  bool healthy = false;
  std::optional<std::uint32_t> spare_version;  // nothing where the other slot has no image
  firmware::update::Problem spare_refusal = firmware::update::Problem::kNone;
};

/// In words, for people.
std::string text_of(firmware::update::Problem problem);

struct UpdateSettings {
  /// From one word to the next: what the bus plan has room for (ParameterWrite's shortest period).
  std::int64_t word_period_ns = 2'000'000;
  /// Longest wait for the new image to answer after the restart, and then to be healthy.
  std::int64_t start_ns = 10'000'000'000;
  std::int64_t healthy_ns = 15'000'000'000;
};

class UpdateClient {
 public:
  /// Called as it goes on, `done` of `all` words.
  using Progress = std::function<void(std::size_t done, std::size_t all)>;

  /// @param client connected; must outlive this
  explicit UpdateClient(ServiceClient& client, const UpdateSettings& settings = {})
      : client_(client), settings_(settings) {}

  /// Nothing where the foot cannot be updated.
  std::optional<ImageStatus> read_status();

  /// The image of the file for the slot that does not run. @throws ServiceError where the foot
  /// would refuse it, saying why and what to do
  const UpdateImage& choose(const UpdateFile& file, const ImageStatus& status) const;

  /// Sends it; goes on where a transfer of the same image was left. What was lost on the way is
  /// sent again. @throws ServiceError where the foot refuses
  void send(const UpdateImage& image, const Progress& progress);

  /// Restarts the foot and confirms the new image once it is healthy.
  /// @throws ServiceError where the boot loader refused it, or it fails its trial
  void start_and_confirm(const UpdateImage& image);

  /// Of an image that runs on trial. @throws ServiceError where it does not become healthy
  void confirm(std::uint32_t version);

 private:
  using Object = firmware::protocol::UpdateObject;
  using Result = firmware::protocol::ServiceResult;
  using Status = firmware::protocol::Status;

  bool goes_on(const UpdateImage& image);
  void begin(const UpdateImage& image);
  void send_words(const UpdateImage& image, const Progress& progress);
  void finish();
  [[noreturn]] void refused(const std::string& what, Result result);
  ImageStatus wait_for_start();

  ServiceClient& client_;
  UpdateSettings settings_;
};

}  // namespace hoof::bridge
