#include "nodelets/factories.h"
#include "nodelets/stand_alone.h"

int main(int argc, char** argv) {
  return cornerstone::runStandAlone(argc, argv, "registration", cornerstone::makeRegistration);
}
