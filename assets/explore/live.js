// A run that is still going: how far it is, and what a person can do to it. The server tells; nothing is decided here.

export class Live {
  // `say` sends to the server; `turned` is called when the newest state is to be followed, or no longer.
  constructor($, say, turned) {
    Object.assign(this, { $, say, newest: true, ended: false, known: null, reached: false });
    $("live").hidden = false;
    $("newest").onchange = ({ target }) => { this.follow(target.checked); turned(); };
    $("hold").onclick = () => say({ pace: this.known?.pace === "going" ? "held" : "going" });
    $("step").onclick = () => { this.follow(true); say({ pace: "step" }); };
    $("stop").onclick = () => this.askToStop();
    $("stop").onblur = () => this.forget();
  }

  follow(on) {
    this.newest = on;
    this.$("newest").checked = on;
  }

  // The second press within a few seconds is meant.
  askToStop() {
    const { $ } = this;
    if ($("stop").dataset.asked) {
      this.forget();
      this.say({ stop: null });
      return;
    }
    $("stop").dataset.asked = "yes";
    $("stop").textContent = "Press again to stop; results are kept";
    this.timer = setTimeout(() => this.forget(), 5000);
  }

  forget() {
    clearTimeout(this.timer);
    delete this.$("stop").dataset.asked;
    this.$("stop").textContent = "Stop the run";
  }

  // `reached`: it comes from the server that has the run, which can be told something.
  heard(state, reached = true) {
    const { $ } = this;
    this.reached = reached;
    this.known = state;
    this.ended = state.end !== null;
    const going = state.pace === "going" && !state.stopping && !this.ended;
    $("live").dataset.pace = this.ended ? "ended" : state.pace;
    $("progress").value = this.ended ? 1 : state.done;
    $("progress").hidden = this.ended;
    let words = `running, ${(100 * state.done).toFixed(0)} % of what is planned`;
    if (this.ended) words = `The run is over: ${state.end}.`;
    else if (state.stopping) words = "stopping …";
    else if (!going) words = state.pace === "step" ? "to the next state …" : `held at ${(100 * state.done).toFixed(0)} %`;
    if ($("live-text").textContent !== words) $("live-text").textContent = words;
    $("hold").textContent = state.pace === "going" ? "Hold" : "Go on";
    for (const name of ["hold", "step", "stop"]) $(name).disabled = !reached || this.ended || state.stopping;
    $("run-controls").hidden = this.ended;
  }
}
