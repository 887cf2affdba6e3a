// What the page shows, and arrays in it: little-endian numbers in base64.
const data = JSON.parse(document.getElementById("data").textContent);

const ARRAYS = {
  u8: Uint8Array,
  u16: Uint16Array,
  u32: Uint32Array,
  f32: Float32Array,
};

/** The numbers of a packed array, in an array of their type. */
function unpack(packed) {
  const text = atob(packed.data);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return new ARRAYS[packed.type](bytes.buffer);
}

/** The same with its offset, or in seconds where they are times. */
function unpackValues(packed) {
  return Float64Array.from(unpack(packed), (value) => value + (packed.offset ?? 0));
}
function unpackTimes(packed) {
  return Float64Array.from(unpack(packed), (count) => count * data.time_unit);
}

/** The number of entries of an ascending array that are below a value. */
function countBelow(ascending, value) {
  let low = 0;
  let high = ascending.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (ascending[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

const LEVEL_FACTOR = 8;

/**
 * Values over ascending times. Where they are thinned, each entry stands for all values from its
 * time to the next: `low` and `high` are the least and the largest. Levels above the first join
 * LEVEL_FACTOR entries of the one below, so that drawing costs as much as there are pixels.
 */
class Series {
  constructor(times, packed) {
    this.times = times;
    this.packed = packed;
    this.isThinned = packed.high !== undefined;
    this.levels = null;
  }

  /** Of values as they are. */
  static of(times, values) {
    const series = new Series(times, {});
    series.levels = [{low: values, high: values}];
    return series;
  }

  level(number) {
    if (this.levels === null) {
      const low = unpackValues(this.packed.low);
      this.levels = [{low, high: this.isThinned ? unpackValues(this.packed.high) : low}];
      this.packed = null;
    }
    while (this.levels.length <= number) this.levels.push(joined(this.levels[this.levels.length - 1]));
    return this.levels[number];
  }

  /** From the entry that holds at `from`, or the first, to the one after `to`, or the last. */
  indices(from, to) {
    return [Math.max(0, countBelow(this.times, from) - 1),
            Math.min(this.times.length, countBelow(this.times, to) + 1)];
  }

  /** The position of the entry that holds at a time; the first one before it. */
  indexAt(time) {
    return Math.max(0, Math.min(this.times.length - 1, countBelow(this.times, time + 1e-9) - 1));
  }

  /** The least and the largest finite value from one position to before another. */
  limits(begin, end) {
    const number = levelFor(end - begin, 500);
    const {low, high} = this.level(number);
    const size = LEVEL_FACTOR ** number;
    let least = Infinity;
    let largest = -Infinity;
    for (let k = Math.floor(begin / size); k * size < end; ++k) {
      if (low[k] < least) least = low[k];
      if (high[k] > largest) largest = high[k];
    }
    return [least, largest];
  }
}

/** Which level has about as many entries of `count` as are wanted, or more. */
function levelFor(count, wanted) {
  let number = 0;
  while (count / LEVEL_FACTOR ** (number + 1) >= wanted) ++number;
  return number;
}

/** An entry where not all are finite is NaN: a gap must not be drawn over. */
function joined(level) {
  const size = Math.ceil(level.low.length / LEVEL_FACTOR);
  const low = new Float64Array(size).fill(Infinity);
  const high = new Float64Array(size).fill(-Infinity);
  for (let i = 0; i < level.low.length; ++i) {
    const k = Math.floor(i / LEVEL_FACTOR);
    low[k] = Math.min(low[k], level.low[i]);  // NaN where one is
    high[k] = Math.max(high[k], level.high[i]);
  }
  return {low, high};
}
