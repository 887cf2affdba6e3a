// The span of time that linked charts show.
class TimeRange {
  constructor(first, last) {
    this.whole = [first, last > first ? last : first + 1];
    this.past = [];
    this.shown = this.whole;
    this.cursor = null;
    this.listeners = [];
  }

  get isWhole() {
    return this.shown[0] === this.whole[0] && this.shown[1] === this.whole[1];
  }

  /** Shows a span, not beyond the whole one, nor shorter than its hundred-thousandth. */
  show(from, to, {remembers = true} = {}) {
    const least = (this.whole[1] - this.whole[0]) * 1e-5;
    if (to - from < least) {
      const middle = (from + to) / 2;
      [from, to] = [middle - least / 2, middle + least / 2];
    }
    const length = Math.min(to - from, this.whole[1] - this.whole[0]);
    from = Math.max(this.whole[0], Math.min(from, this.whole[1] - length));
    if (remembers) this.past.push(this.shown);
    this.shown = [from, from + length];
    this.tell();
  }

  reset() {
    if (this.isWhole) return;
    this.past.push(this.shown);
    this.shown = this.whole;
    this.tell();
  }

  back() {
    if (this.past.length === 0) return;
    this.shown = this.past.pop();
    this.tell();
  }

  /** Where the pointer is; null where it is not over a chart. */
  point(time) {
    this.cursor = time;
    for (const listener of this.listeners) listener.pointed?.();
  }

  tell() {
    for (const listener of this.listeners) listener.shown?.();
  }
}
