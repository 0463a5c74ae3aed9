#include "tools/diagnose/write_answer.h"

#include "tools/diagnose/answer_tables.h"
#include "tools/diagnose/effects_file.h"
#include "tools/diagnose/experiment_text.h"
#include "tools/diagnose/report_page.h"
#include "tools/diagnose/verdict_json.h"
#include "tools/run/result_json.h"

namespace hoof::tools {

void write_answer(const Verdict& verdict, const std::vector<DataSet>& data_sets,
                  AnswerFolder& folder) {
  std::vector<std::string> names;
  for (const DataSet& set : data_sets) names.push_back(set.name);
  folder.write(kVerdictFile, result_json_text(verdict_json(verdict)));
  folder.write("report.html", report_page(verdict, data_sets));
  folder.write("improved.toml", effects_file_text(verdict, names));
  folder.write("residuals.csv", residuals_csv(verdict.traces));
  folder.write("hypotheses.csv", hypotheses_csv(verdict.hypotheses));
  if (verdict.planned_experiment) {
    std::vector<std::string> files;
    for (const DataSet& set : data_sets) files.push_back(set.file.string());
    folder.write(kExperimentFile, experiment_toml(*verdict.planned_experiment, files));
    folder.write(kExperimentTable, experiment_csv(*verdict.planned_experiment));
  } else {
    folder.leave_out(kExperimentFile);
    folder.leave_out(kExperimentTable);
  }
  folder.commit();
}

}  // namespace hoof::tools
