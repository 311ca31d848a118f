// What the plots of all pages have in common: how far their axes go, where the ticks are, and the colours of the page.

export const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// A few powers of ten.
export function decades(u, axis, low, high) {
  const first = Math.ceil(Math.log10(low) - 1e-9), last = Math.floor(Math.log10(high) + 1e-9), stride = Math.ceil((last - first + 1) / 4);
  const splits = [];
  for (let k = last; k >= first; k -= stride) splits.unshift(10 ** k);
  return splits;
}

export function whole_decades(u, low, high) {
  if (low === null || high === null) return [0.1, 1];
  const first = Math.floor(Math.log10(low)), last = Math.ceil(Math.log10(high));
  return [10 ** first, 10 ** Math.max(last, first + 1)];
}

// With zero where that does not hide what happens.
export function linear_range(u, low, high) {
  if (low === null || high === null || (low === 0 && high === 0)) return [0, 1];
  if (low >= 0 && low < 0.5 * high) low = 0;
  const room = 0.06 * (high - low || Math.abs(high) || 1);
  return [low === 0 ? 0 : low - room, high + room];
}
