#include "cornerstone/base/errors.h"

#include <cmath>
#include <sstream>

namespace cornerstone {

void requireFinite(double value, const std::string& name) {
  if (!std::isfinite(value)) throw InputError(name + " is not a finite number");
}

void requirePositive(double value, const std::string& name) {
  requireFinite(value, name);
  if (value > 0) return;
  std::ostringstream text;
  text << name << " is " << value << ", it must be greater than 0";
  throw InputError(text.str());
}

void requireWithin(double value, double low, double high, const std::string& name) {
  requireFinite(value, name);
  if (value >= low && value <= high) return;
  std::ostringstream text;
  text << name << " is " << value << ", it must be from " << low << " to " << high;
  throw InputError(text.str());
}

}  // namespace cornerstone
