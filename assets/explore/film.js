// A film of the camera: views that it comes by, in their order. The server draws it, as the command line does.

export class Film {
  // `present` gives the view on the screen, `finish` makes one ready for a file, `show` goes to one, `name` says what it shows, `size` is that of the film.
  constructor($, { say, present, finish, show, name, size, file }) {
    Object.assign(this, { $, say, present, show, name, size, file, finish, views: [], making: false });
    $("add-view").onclick = () => this.add();
    $("make-film").onclick = () => this.make();
    $("film-words").onclick = () => this.say({ "film-command": this.asked() });
    $("no-film").onclick = () => { this.say({ "no-film": null }); this.end(""); };
    this.list();
  }

  add() {
    this.views.push(this.present());
    this.list();
    this.$("film-text").textContent = this.views.length < 2 ? "Now move on, and add the next view." : "";
  }

  asked() {
    return { size: this.size(), seconds: +this.$("leg").value || 2, views: this.views.map(this.finish) };
  }

  make() {
    this.making = true;
    this.say({ film: this.asked() });
    this.$("film-progress").value = 0;
    this.list();
  }

  end(words) {
    this.making = false;
    this.$("film-text").textContent = words;
    this.list();
  }

  list() {
    const { $ } = this;
    const rows = this.views.map((view, k) => {
      const row = document.createElement("li"), go = document.createElement("button"), off = document.createElement("button");
      Object.assign(go, { type: "button", textContent: this.name(view), onclick: () => this.show(structuredClone(view)) });
      Object.assign(off, { type: "button", textContent: "×", onclick: () => { this.views.splice(k, 1); this.list(); $("add-view").focus(); } });
      off.setAttribute("aria-label", `Take view ${k + 1} out of the film`);
      row.append(go, off);
      return row;
    });
    $("views").replaceChildren(...rows);
    $("views").hidden = !rows.length;
    for (const name of ["make-film", "film-words"]) $(name).disabled = this.making || rows.length < 2;
    for (const name of ["film-progress", "no-film"]) $(name).hidden = !this.making;
  }

  heard({ done, of }) {
    if (!this.making) return;
    this.$("film-progress").value = done / of;
    this.$("film-text").textContent = `${done} of ${of} pictures`;
  }

  received(bytes) {
    if (!this.making) return;
    this.file(new Blob([bytes], { type: "video/mp4" }), "mp4");
    this.end(`The film is saved, ${(bytes.length / 1e6).toFixed(1)} MB.`);
  }
}
