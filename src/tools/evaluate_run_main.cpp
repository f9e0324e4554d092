#include "cornerstone/base/errors.h"
#include "tools/program.h"
#include "tools/run_metrics.h"

int main(int argc, char** argv) {
  using namespace cornerstone;
  return runProgram("evaluate_run", [&] {
    const Arguments arguments(argc, argv, "evaluate_run BAG_OR_RESULTS [--range M]", 1, {"range"});
    Sight sight;
    sight.range_m = arguments.number("range", sight.range_m);
    requirePositive(sight.range_m, "--range");
    const nlohmann::json result = evaluateRun(readRun(arguments.positional(0)), sight);
    return Outcome{result.at("registered").get<bool>() ? kExitDone : kExitNoAnswer, result};
  });
}
