// A drawing in metres with a colour bar, as SVG.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace hoof::tools {

/// How values become colours, and what stands beside the bar.
struct ColourBar {
  double most = 1;    // the colour of the end; below zero that of zero
  double factor = 1;  // to the unit shown
  std::string unit;

  /// To what one in a hundred of the values exceeds.
  static ColourBar of(std::vector<double> values, double factor, std::string unit);
  std::string colour(double value) const;
};

class MapCanvas {
 public:
  /// @param window_m what is shown: x to the right, the second coordinate up
  MapCanvas(const Eigen::AlignedBox2d& window_m, std::string label);

  const Eigen::AlignedBox2d& window_m() const { return window_m_; }
  void circle(const Eigen::Vector2d& at_m, double radius_m, const std::string& fill);
  void line(const Eigen::Vector2d& a_m, const Eigen::Vector2d& b_m, double width_px,
            const std::string& colour);
  void rectangle(const Eigen::AlignedBox2d& box_m, const std::string& fill);
  void triangle(const Eigen::Vector2d corners_m[3], const std::string& fill);
  /// The whole drawing, with the bar and a scale of length below.
  std::string finish(const ColourBar& bar) const;

 private:
  double x_px(double x_m) const { return (x_m - window_m_.min().x()) * kPixels_m; }
  double y_px(double y_m) const { return (window_m_.max().y() - y_m) * kPixels_m; }

  static constexpr double kPixels_m = 2200;  // 300 mm are 660 pixels wide

  Eigen::AlignedBox2d window_m_;
  std::string label_;
  std::string body_;
};

}  // namespace hoof::tools
