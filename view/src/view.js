{
  const view = motionView();
  view.show(view.decode(JSON.parse(document.getElementById("data").textContent)));
}
