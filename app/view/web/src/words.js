// Numbers as text.

// Four digits at most, without zeros that say nothing.
export function short(x) {
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (size >= 1e5 || size < 1e-3) return x.toExponential(size >= 1e5 ? 2 : 1).replace("e+", "e");
  return String(Number(x.toPrecision(4)));
}

// So many decimals as the step between two values asks for.
export function fixed(x, step) {
  return x.toFixed(Math.max(2, Math.min(7, Math.ceil(-Math.log10(step || 1e-6)))));
}
