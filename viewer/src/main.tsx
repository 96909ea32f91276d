import { render } from 'preact';
import { effect } from '@preact/signals';
import 'uplot/dist/uPlot.min.css';
import './ui/theme.css';
import './ui/layout.css';
import './ui/controls.css';
import './ui/help.css';
import './ui/experiment.css';
import './scene/stage.css';
import './panels/panels.css';
import './panels/cameras.css';
import './panels/finder.css';
import './plots/plots.css';
import './timeline/timeline.css';
import './teach/teach.css';
import { pasted_token, take_token } from './connection/address';
import { bindings_of, is_in_sight } from './keys/bindings';
import { KeyMap } from './keys/keys';
import { preferences, theme_now } from './state/preferences';
import { Viewer } from './state/viewer';
import { AppContext, make_app } from './ui/app';
import { Page } from './ui/Page';
import { apply_sizes } from './ui/sizes';

let token = take_token(location, history);
const viewer = new Viewer({
  base: new URL('.', location.href).href,
  token: () => token,
  settle: (tried) => {
    if (tried === token) token = null;
  },
});
const come_in = (with_token: string | null): boolean => {
  if (with_token === null) return false;
  token = with_token;
  void viewer.link.open();
  return true;
};
const app = make_app(viewer, new KeyMap({
  enabled: (binding) => preferences.keys.value && is_in_sight(binding, app.route.value, viewer.hello.value?.mode !== 'pictures'),
}));
app.keys.add(...bindings_of(app));
app.use_token = (text) => come_in(pasted_token(text));
addEventListener('keydown', app.keys.handle);
const route = (): void => {
  // An address pasted into this tab changes the hash only.
  come_in(take_token(location, history));
  app.route.value = location.hash === '#/teach' ? 'teach' : 'viewer';
};
addEventListener('hashchange', route);
route();
effect(() => {
  document.documentElement.dataset.theme = theme_now();
});
effect(() => {
  const title = viewer.hello.value?.title;
  document.title = title ? `${title} – Flexura` : 'Flexura';
});
apply_sizes();
render(
  <AppContext.Provider value={app}>
    <Page />
  </AppContext.Provider>,
  document.getElementById('app')!,
);
void viewer.link.open();
// Values for external tests (test/e2e): drawn frames, the shown state, the viewpoint of the free view, the screen
// position of the tip. The page itself does not use them.
Object.assign(globalThis, {
  flexura: {
    drawn: () => app.view.value?.drawn ?? 0,
    shown: () => viewer.shown,
    orbit: () => app.view.value?.orbit,
    tip: (s?: number) => app.view.value?.on_screen(s) ?? null,
  },
});
