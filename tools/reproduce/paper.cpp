#include "tools/reproduce/paper.h"

#include <cmath>

namespace hoof::tools {

const std::vector<PaperSinkage>& paper_sinkages() {
  static const std::vector<PaperSinkage> rows = {
      {"sinkage-bionic-toe0-10kg-0.1m_s", 2.2},
      {"sinkage-traditional-10kg-0.1m_s", 7.1},
      {"sinkage-bionic-plain-toe0-10kg-0.1m_s", 2.5, false},
      {"sinkage-bionic-toe0-10kg-0.4m_s", 3.1},
      {"sinkage-traditional-10kg-0.4m_s", 7.8},
      {"sinkage-bionic-plain-toe0-10kg-0.4m_s", 3.6, false},
      {"sinkage-bionic-toe0-40kg-0.1m_s", 8.1},
      {"sinkage-traditional-40kg-0.1m_s", 27.1},
      {"sinkage-bionic-plain-toe0-40kg-0.1m_s", 9.5, false},
      {"sinkage-bionic-toe0-40kg-0.4m_s", 9.5},
      {"sinkage-traditional-40kg-0.4m_s", 29.2},
      {"sinkage-bionic-plain-toe0-40kg-0.4m_s", 11.2},
      {"sinkage-bionic-toe0-60kg-0.1m_s", 13.0, false},
      {"sinkage-bionic-toe0-60kg-0.4m_s", 14.74, false},
      {"sinkage-bionic-toe10-10kg-0.1m_s", 2.02},
      {"sinkage-bionic-toe30-10kg-0.1m_s", 1.95},
      {"sinkage-bionic-toe40-10kg-0.1m_s", 2.16},
      {"sinkage-bionic-toe10-60kg-0.1m_s", 11.73},
      {"sinkage-bionic-toe30-60kg-0.1m_s", 11.25},
      {"sinkage-bionic-toe40-60kg-0.1m_s", 11.65},
      {"sinkage-bionic-toe10-10kg-0.4m_s", 2.95},
      {"sinkage-bionic-toe30-10kg-0.4m_s", 2.81},
      {"sinkage-bionic-toe40-10kg-0.4m_s", 3.08},
      {"sinkage-bionic-toe10-60kg-0.4m_s", 13.44},
      {"sinkage-bionic-toe30-60kg-0.4m_s", 13.02},
      {"sinkage-bionic-toe40-60kg-0.4m_s", 13.48}};
  return rows;
}

const std::vector<PaperTraction>& paper_tractions() {
  static const std::vector<PaperTraction> rows = {
      {"traction-bionic-toe0-0.45Hz", 259.87, 406.76, 0.639},
      {"traction-bionic-plain-toe0-0.45Hz", 259.58, 599.25, 0.433},
      {"traction-traditional-0.45Hz", 101.19, 211.35, 0.479},
      {"traction-bionic-toe0-1.12Hz", 431.20, 664.15, 0.649},
      {"traction-bionic-plain-toe0-1.12Hz", 442.12, 1075.29, 0.411},
      {"traction-traditional-1.12Hz", 158.03, 333.50, 0.474},
      {"traction-bionic-toe10-0.45Hz", 0, 0, 0.636},
      {"traction-bionic-toe20-0.45Hz", 0, 0, 0.645},
      {"traction-bionic-toe30-0.45Hz", 0, 0, 0.643},
      {"traction-bionic-toe40-0.45Hz", 0, 0, 0.681},
      {"traction-bionic-toe10-1.12Hz", 0, 0, 0.648},
      {"traction-bionic-toe20-1.12Hz", 0, 0, 0.641},
      {"traction-bionic-toe30-1.12Hz", 0, 0, 0.656},
      {"traction-bionic-toe40-1.12Hz", 0, 0, 0.676}};
  return rows;
}

double paper_sinkage_mm(const std::string& condition) {
  for (const PaperSinkage& row : paper_sinkages()) {
    if (row.condition == condition) return row.sinkage_mm;
  }
  return NAN;
}

PaperTraction paper_traction(const std::string& condition) {
  for (const PaperTraction& row : paper_tractions()) {
    if (row.condition == condition) return row;
  }
  return {};
}

}  // namespace hoof::tools
