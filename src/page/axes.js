// Numbers and ticks of axes.

/** A number with so many digits, as short as it can be. */
function shortNumber(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-3 || size >= 1e6) ? value.toExponential(digits - 1)
                                                          : String(Number(value.toPrecision(digits)));
  return text.replace("e+", "e").replace(/\.?0+e/, "e").replaceAll("-", "−");
}

/** Ticks at round numbers, about so many, and not closer than `least`. */
function linearTicks(low, high, count, least = 0) {
  const raw = Math.max(least, (high - low) / Math.max(1, count));
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= raw * 0.999);
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) ticks.push(k * step);
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const isPlain = Math.max(Math.abs(low), Math.abs(high)) < 1e6 && step >= 1e-5;
  const label = (value) => (Math.abs(value) < 1e-9 * step ? "0" : isPlain ? value.toFixed(decimals).replace(/^-0(\.0*)?$/, "0")
                                    : Number(value.toPrecision(8)).toExponential().replace("e+", "e"))
    .replaceAll("-", "−");
  return ticks.map((value) => ({value, label: label(value)}));
}

/** Ticks at powers of ten; their exponents low to high. Where there are few, at 2 and 5 times too, or at round numbers. */
function logTicks(low, high, count) {
  const first = Math.ceil(low - 1e-9);
  const last = Math.floor(high + 1e-9);
  if (last - first < 2) {
    const ticks = [];
    for (let exponent = Math.floor(low); exponent <= high; ++exponent) {
      for (const factor of [1, 2, 5]) {
        const value = exponent + Math.log10(factor);
        if (value >= low && value <= high) {
          ticks.push({value, label: shortNumber(factor * 10 ** exponent, 2)});
        }
      }
    }
    if (ticks.length >= 2) return ticks;
    return linearTicks(10 ** low, 10 ** high, count).filter(({value}) => value > 0).map(({value, label}) => ({value: Math.log10(value), label}));
  }
  const step = Math.max(1, Math.ceil((last - first) / Math.max(1, count)));
  const ticks = [];
  for (let exponent = first; exponent <= last; exponent += step) {
    ticks.push({value: exponent, label: shortNumber(10 ** exponent, 2)});
  }
  return ticks;
}

/** The colour that the style sheet gives a name now. */
function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
}
