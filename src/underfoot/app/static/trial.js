// Signals over one time axis with events that are moved by pointer or arrow keys. NiceGUI element.
const LEFT = 58, RIGHT = 14, TOP = 30, GAP = 14, AXIS = 34;

function ticks(low, high, most) {
  const raw = (high - low) / Math.max(1, most), size = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((f) => f * size).find((s) => s >= raw);
  const all = [];
  for (let v = Math.ceil(low / step - 1e-9) * step; v <= high + 1e-9 * step; v += step) all.push(+v.toPrecision(12));
  return all;
}

export default {
  template: `
<div class="trial-plot">
 <svg :width="width" :height="height" role="group" :aria-label="words.plot">
  <rect v-for="b in plot.bands" :key="'b' + b.id" class="band" :class="[b.verdict, { chosen: b.id === chosen }]"
    :x="x(b.begin)" :width="Math.max(2, x(b.end) - x(b.begin))" :y="TOP - 4" :height="height - TOP - AXIS + 4"
    v-bind="choosing ? { role: 'button', tabindex: 0, 'aria-label': words.step + ' ' + b.id } : {}"
    @click="choosing && $emit('chosen', b.id)" @keydown.enter="choosing && $emit('chosen', b.id)"/>
  <text v-if="choosing" v-for="b in plot.bands" :key="'n' + b.id" class="number" :x="x((b.begin + b.end) / 2)" :y="TOP - 10">{{ b.id }}</text>
  <g v-for="(p, i) in panels" :key="p.id">
   <g v-for="v in p.ticks" :key="v"><line class="grid" :x1="LEFT" :x2="width - RIGHT" :y1="p.y(v)" :y2="p.y(v)"/>
    <text class="tick up" :x="LEFT - 6" :y="p.y(v) + 4">{{ v }}</text></g>
   <text v-if="panel > 60" class="label" :transform="'translate(13 ' + (p.top + p.high / 2) + ') rotate(-90)'">{{ words[p.id] || p.id }}</text>
   <path v-for="(d, k) in p.paths" :key="k" class="curve" :class="'c' + k" :d="d"/>
   <text v-if="p.lines.length > 1" v-for="(l, k) in p.lines" :key="'l' + k" class="key" :class="'c' + k"
     :x="width - RIGHT - 4" :y="p.top + 12 + 14 * k">{{ words[l.name] || l.name }}</text>
  </g>
  <text v-for="v in times" :key="'t' + v" class="tick" :x="x(v)" :y="height - AXIS + 16">{{ v }}</text>
  <text class="label" :x="(LEFT + width - RIGHT) / 2" :y="height - 3">{{ words.time }}</text>
  <g v-for="e in marks" :key="e.id">
   <template v-if="e.value !== undefined"><circle class="mark" :cx="x(e.time)" :cy="panels[e.panel].y(e.value)" r="4.5"/>
    <text class="name" :x="x(e.time) + 8" :y="panels[e.panel].y(e.value) - 7">{{ words[e.id] || e.id }} {{ e.value.toFixed(3) }}</text></template>
   <template v-else><line class="mark" :x1="x(e.time)" :x2="x(e.time)" :y1="span(e)[0]" :y2="span(e)[1]"/>
    <text class="name" :x="x(e.time) + 4" :y="span(e)[1] - 5">{{ words[e.id] || e.id }}</text></template>
  </g>
  <g v-for="e in handles" :key="e.id" class="handle" :class="{ moved: e.id === moving }" role="slider" tabindex="0"
    :aria-label="words[e.id] || e.id" :aria-valuemin="e.least" :aria-valuemax="e.most" :aria-valuenow="at(e)"
    :aria-valuetext="text(e)" :data-event="e.id" @pointerdown="grab($event, e)" @pointermove="drag($event, e)"
    @pointerup="drop(e)" @pointercancel="cancel" @keydown="key($event, e)">
   <line :x1="x(at(e))" :x2="x(at(e))" :y1="TOP - 4" :y2="height - AXIS"/>
   <rect class="grip" :x="x(at(e)) - 14" :y="TOP - 4" width="28" :height="height - TOP - AXIS + 4"/>
   <path class="knob" :d="'M' + (x(at(e)) - 7) + ' ' + (TOP - 16) + 'h14v8l-7 8l-7 -8z'"/>
   <text :x="x(at(e)) + (late(e) ? -11 : 11)" :y="TOP - 8" :text-anchor="late(e) ? 'end' : 'start'">{{ width < 560 ? at(e).toFixed(3) + ' s' : text(e) }}</text>
  </g>
 </svg>
</div>`,
  props: { plot: Object, words: Object, chosen: Number, choosing: Boolean, panel: { default: 150 }, revision: Number },
  data: () => ({ width: 700, moving: null, time: 0, LEFT, RIGHT, TOP, AXIS }),
  mounted() {
    this.width = Math.max(280, this.$el.clientWidth);
    this.observer = new ResizeObserver(([e]) => { this.width = Math.max(280, Math.floor(e.contentRect.width)); });
    this.observer.observe(this.$el);
  },
  beforeUnmount() { this.observer.disconnect(); clearTimeout(this.waiting); },
  watch: { revision() { this.moving = null; } },
  computed: {
    height() { return TOP + this.plot.panels.length * (this.panel + GAP) + AXIS; },
    panels() {
      return this.plot.panels.map((p, i) => {
        const top = TOP + i * (this.panel + GAP), reach = 1.06 * (p.high - p.low);
        const y = (v) => top + this.panel * (1 - (v - p.low) / reach);
        const paths = p.lines.map((l) => this.path(l, y));
        return { ...p, top, y, paths, height: this.panel, high: this.panel, ticks: ticks(p.low, p.high, Math.max(2, this.panel / 30)) };
      });
    },
    times() { return ticks(this.plot.begin, this.plot.end, Math.max(3, this.width / 110)); },
    handles() { return (this.plot.events || []).filter((e) => e.least !== undefined); },
    marks() { return (this.plot.events || []).filter((e) => e.least === undefined); },
  },
  methods: {
    x(t) { return LEFT + (this.width - LEFT - RIGHT) * (t - this.plot.begin) / (this.plot.end - this.plot.begin); },
    path(line, y) {
      let d = "", pen = "M";
      line.low.forEach((low, i) => {
        if (low === null) { pen = "M"; return; }
        const px = this.x(line.x ? line.x[i] : line.start + i * line.spacing).toFixed(1);
        if (+px < LEFT || +px > this.width - RIGHT) return;
        d += `${pen}${px} ${y(low).toFixed(1)}` + (line.high.length ? `L${px} ${y(line.high[i]).toFixed(1)}` : "");
        pen = "L";
      });
      return d;
    },
    span(e) {
      if (e.panel === undefined) return [TOP, this.height - AXIS];
      const p = this.panels[e.panel];
      return [p.top, p.top + this.panel];
    },
    at(e) { return e.id === this.moving ? this.time : e.time; },
    late(e) { return e.id === "toe off" || this.x(this.at(e)) > this.width - 170; },
    text(e) { return `${this.words[e.id] || e.id} ${this.at(e).toFixed(3)} s`; },
    move(e, time) {
      const step = this.plot.spacing, snapped = e.time + Math.round((time - e.time) / step) * step;
      this.moving = e.id;
      this.time = Math.min(Math.max(snapped, e.least, this.plot.begin), e.most, this.plot.end);
    },
    grab(event, e) { event.currentTarget.setPointerCapture(event.pointerId); this.move(e, this.at(e)); this.from = event.clientX; this.was = this.time; event.preventDefault(); event.currentTarget.focus(); },
    drag(event, e) {
      if (this.from === undefined || this.moving !== e.id) return;
      const scale = (this.plot.end - this.plot.begin) / (this.width - LEFT - RIGHT);
      this.move(e, this.was + (event.clientX - this.from) * scale);
    },
    drop(e) { if (this.from === undefined) return; this.from = undefined; this.send(e); },
    send(e) {
      if (Math.abs(this.time - e.time) < this.plot.spacing / 2) { this.moving = null; return; }
      this.$emit("moved", { id: e.id, time: this.time });
    },
    cancel() { this.from = undefined; this.moving = null; },
    key(event, e) {
      const steps = { ArrowLeft: -1, ArrowRight: 1, ArrowDown: -1, ArrowUp: 1, PageDown: -10, PageUp: 10 }[event.key];
      if (event.key === "Escape") this.cancel();
      if (!steps) return;
      event.preventDefault();
      this.move(e, this.at(e) + steps * (event.shiftKey ? 10 : 1) * this.plot.spacing);
      clearTimeout(this.waiting);
      this.waiting = setTimeout(() => this.send(e), 350);
    },
  },
};
