#include "tools/calibrate/paper_tables.h"

namespace hoof::tools {

const std::vector<ReposeRow>& paper_repose_table() {
  static const std::vector<ReposeRow> rows = {
      {0.8, 0.4, 0.55, 39.5},    {0.45, 0.25, 0.55, 31.08}, {0.45, 0.4, 0.2, 17.88},
      {0.8, 0.25, 0.9, 33.3},    {0.1, 0.4, 0.55, 39.32},   {0.45, 0.25, 0.55, 31.86},
      {0.45, 0.25, 0.55, 32.03}, {0.1, 0.1, 0.55, 8.51},    {0.45, 0.1, 0.9, 12.04},
      {0.45, 0.1, 0.2, 1.18},    {0.45, 0.4, 0.9, 55.2},    {0.1, 0.25, 0.2, 8.54},
      {0.8, 0.25, 0.2, 8.46},    {0.45, 0.25, 0.55, 32.18}, {0.8, 0.1, 0.55, 6.2},
      {0.45, 0.25, 0.55, 31.15}, {0.1, 0.25, 0.9, 34.49}};
  return rows;
}

double paper_repose_fit_deg(double a, double b, double c) {
  return -28.24 + 28.86 * a + 116.45 * b + 59.96 * c + 11.86 * a * b - 2.27 * a * c +
         126.0 * b * c - 35.33 * a * a - 175.56 * b * b - 50.08 * c * c;
}

const std::vector<PaperRow>& paper_tilt_table() {
  static const std::vector<PaperRow> rows = {
      {0.375, 20.90}, {0.4, 22.03},   {0.425, 23.22}, {0.45, 24.41},  {0.475, 25.66},
      {0.5, 26.84},   {0.525, 27.85}, {0.55, 29.02},  {0.575, 30.14}, {0.6, 31.29},
      {0.625, 32.18}, {0.65, 33.32},  {0.675, 34.27}};
  return rows;
}

const std::vector<PaperRow>& paper_roll_table() {
  static const std::vector<PaperRow> rows = {{0.01, 37.12}, {0.025, 36.73}, {0.05, 36.26},
                                             {0.1, 35.66},  {0.15, 35.30},  {0.2, 34.68},
                                             {0.25, 33.85}, {0.3, 33.08}};
  return rows;
}

}  // namespace hoof::tools
