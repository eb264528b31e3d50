// Sliders and fields of the concrete that is being changed.

const slider = {
  from: (f, value) => f.log ? (1000 * Math.log(Math.max(value, f.low) / f.low)) / Math.log(f.high / f.low) :
                              (1000 * (value - f.low)) / (f.high - f.low),
  value: (f, at) => {
    const raw = f.log ? f.low * (f.high / f.low) ** (at / 1000) : f.low + ((f.high - f.low) * at) / 1000;
    return Number(raw.toPrecision(f.log ? 2 : 3));
  },
};

function mark(text, wrong) {
  wrong ? text.setAttribute("aria-invalid", "true") : text.removeAttribute("aria-invalid");
}

/// Builds the choices; change(key, value) is called when one is made.
function buildChoices(place, change) {
  for (const {key, word, options} of choices) {
    const select = element("select", {id: `choice-${key}`});
    for (const [value, name] of Object.entries(options)) select.append(element("option", {value}, name));
    select.addEventListener("change", () => change(key, select.value));
    place.append(element("div", {class: "line"}, element("label", {for: `choice-${key}`}, word), select));
  }
}

/// Builds the fields; change(key, value) is called when a value is settled, never for one that cannot be run.
function buildFields(place, change) {
  for (const f of fields) {
    const label = element("label", { for: `field-${f.key}`
    }, f.word, " ", element("i", {}, f.symbol));
    const range = element(
        "input", {type: "range", id: `slider-${f.key}`, min: 0, max: 1000, step: 1, "aria-label": `${f.word}, slider`});
    const text = element("input", {
      type: "text",
      id: `field-${f.key}`,
      inputmode: "decimal",
      autocomplete: "off",
      "aria-describedby": `wrong-${f.key}`
    });
    const unit = element("span", {class: "unit"}, unitShown[f.unit] ?? f.unit);
    const trouble = element("p", {class: "wrong", id: `wrong-${f.key}`, role: "alert"});
    const settle = (value) => {
      trouble.textContent = wrong(f, value);
      mark(text, Boolean(trouble.textContent));
      if (trouble.textContent) return;
      showField(f, value);
      change(f.key, value);
    };
    range.addEventListener("input", () => (text.value = slider.value(f, range.value)));
    range.addEventListener("change", () => settle(slider.value(f, range.value)));
    text.addEventListener("change", () => settle(readNumber(text.value)));
    place.append(element("div", {class: "field", id: `of-${f.key}`}, label, element("div", {class: "value"}, text, unit), range, trouble));
  }
}

/// The first field whose text is no value; undefined where all are.
function firstWrong() {
  return fields.find((f) => byId(`wrong-${f.key}`).textContent);
}

function showField(f, value) {
  byId(`field-${f.key}`).value = value;
  byId(`slider-${f.key}`).value = slider.from(f, value);
  byId(`wrong-${f.key}`).textContent = "";
  mark(byId(`field-${f.key}`), false);
}

function showConcrete(concrete) {
  for (const f of fields) showField(f, concrete[f.key]), (byId(`of-${f.key}`).hidden = !counts(f, concrete));
  for (const {key} of choices) byId(`choice-${key}`).value = concrete[key];
  byId("mix").value = mixOf(concrete);
}

function buildMixes(choose) {
  for (const [name, mix] of Object.entries(mixes)) byId("mix").append(element("option", {value: name}, mix.name));
  byId("mix").append(element("option", {value: ""}, "your mix"));
  byId("mix").addEventListener("change", () => byId("mix").value && choose(byId("mix").value));
}
