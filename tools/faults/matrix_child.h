// A copy of the whole process that does one thing and hands back plain numbers.
#pragma once

#include <functional>
#include <span>
#include <string>

namespace hoof::tools {

/// A mode of the foot is reached once and copied by fork for each fault: nothing of the foot, its
/// plant and its firmware can be copied otherwise.
class MatrixChild {
 public:
  /// @param work runs in the copy; returns what is to be handed back, of any plain type
  /// @throws std::runtime_error where the system has no more processes or pipes
  template <typename Result>
  static MatrixChild start(const std::function<Result()>& work) {
    return MatrixChild([&work](int pipe) {
      const Result result = work();
      return send(pipe, {reinterpret_cast<const char*>(&result), sizeof result});
    });
  }

  MatrixChild(MatrixChild&& other) noexcept;
  MatrixChild& operator=(MatrixChild&&) = delete;
  /// Ends the copy if it still runs.
  ~MatrixChild();

  /// Waits for the copy's end. @return empty, or what went wrong with it
  template <typename Result>
  std::string finish(Result& result) {
    return receive({reinterpret_cast<char*>(&result), sizeof result});
  }

 private:
  explicit MatrixChild(const std::function<bool(int)>& work);
  static bool send(int pipe, std::span<const char> bytes);
  std::string receive(std::span<char> bytes);

  int pid_ = -1;
  int pipe_ = -1;
};

}  // namespace hoof::tools
