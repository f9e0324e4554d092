#include "nodelets/factories.h"
#include "nodelets/stand_alone.h"

int main(int argc, char** argv) {
  return cornerstone::runStandAlone(argc, argv, "trinocular_stereo", cornerstone::makeTrinocularStereo);
}
