// Suggests gains and dead zones from the values that the controls took at rest and in strong
// expressions.

const restMargin = 1.2, smallestDeadZone = 0.01, largestDeadZone = 0.3;
const target = 0.95;       // of a control in its strongest expression
const leastMovement = 0.25;  // beyond the dead zone; weaker controls were not shown
const gainRange = [0.5, 3];

const rounded = (value, steps) => Math.round(value * steps) / steps;

// The highest values of each control, in the order of controlNames.
class Peaks {
  constructor() { this.values = controlNames.map(() => 0); }

  add(controls) { this.values = this.values.map((value, i) => Math.max(value, controls[i] ?? 0)); }
}

function suggestion(rest, strongest) {
  const wanted = Math.min(largestDeadZone, rest * restMargin), deadZone = wanted < smallestDeadZone ? 0 : wanted;
  const reached = (strongest - deadZone) / (1 - deadZone);
  const gain = reached < leastMovement ? 1 : Math.min(gainRange[1], Math.max(gainRange[0], target / reached));
  return {gain: rounded(gain, 20), dead_zone: rounded(deadZone, 100)};
}

const suggestions = (rest, strongest) =>
  Object.fromEntries(controlNames.map((name, i) => [name, suggestion(rest.values[i], strongest.values[i])]));
