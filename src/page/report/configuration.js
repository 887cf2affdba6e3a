// What the run was configured with, and what its certificate says.

function configurationSection() {
  const {guarantee, certificate, warnings, files} = data.configuration;
  const made = section("configuration", "Configuration and proof", "", "Configuration");
  const list = element("dl");
  const say = (name, text) => list.append(element("dt", {textContent: name}), element("dd", {textContent: text}));
  say("observer", data.observer);
  if (guarantee) say("guarantee", guarantee);
  for (const warning of warnings) say("warning", warning);
  for (const [name, value] of certificate) if (name !== "guarantee") say("certificate: " + name, value);
  made.append(list);
  for (const {name, text} of files) {
    made.append(element("details", {}, element("summary", {textContent: name}), element("pre", {textContent: text})));
  }
}
