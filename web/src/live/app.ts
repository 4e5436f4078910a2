// SPDX-License-Identifier: Apache-2.0
// The page as a whole: who is logged in, which view is open, when it is drawn.
import { theme } from '../frame/theme';
import { Api, ApiError } from './api/client';
import { Stream } from './api/stream';
import type { Machine, Mode, Session, SessionAnswer } from './api/types';
import { type Connection, Head } from './shell/head';
import type { Context, LiveView } from './shell/context';
import { h } from './shell/h';
import { keyOf, routeOf } from './shell/route';
import { logInPage } from './shell/login';
import { problemText } from './shell/problem';
import { applyLook } from './shell/look';
import { nav } from './shell/nav';
import { stagedBar } from './shell/staged_bar';
import { Toast } from './shell/toast';
import { Live } from './state/live';
import { type Settings, loadSettings, saveSettings } from './state/settings';
import { Staged } from './state/staged';
import { chooseUnits } from './state/units';
import { chooseLanguage, t } from './texts/texts';
import { VIEWS } from './views/views';

const FRAME_MS = 1000 / 30;
/** Where the server has not said how to log in. */
const NO_SESSION: SessionAnswer = { session: null, accounts: true, key_login: true };
/** Figures change this often: faster cannot be read. */
const FIGURES_MS = 200;

export class App {
  private readonly api = new Api();
  private readonly toast = new Toast();
  private settings = loadSettings();
  private context: Context | undefined;
  private head: Head | undefined;
  private view: LiveView | undefined;
  private stream: Stream | undefined;
  private connection: Connection = { state: 'connecting' };
  private mode: Mode | undefined;
  /** When the last message came, and since when there have been none; of the wall clock, as a log-in may lie between. */
  private heard: number | undefined;
  private lost: number | undefined;
  private drawn = 0;
  private figures = 0;

  constructor(private readonly host: HTMLElement) {}

  async start(): Promise<void> {
    this.useSettings();
    this.host.replaceChildren(h('div', { class: 'wait' }, h('p', { class: 'product' }, 'Steadyrest'), h('p', {}, t('loading'))));
    document.body.append(this.toast.root);
    this.api.onLoggedOut = () => this.loggedOut(t('logged_out'));
    window.addEventListener('hashchange', () => (keyOf(window.location.hash) === undefined ? this.openView() : void this.identify()));
    window.addEventListener('resize', () => this.view?.redraw?.(theme()));
    for (const query of ['(prefers-color-scheme: dark)', '(prefers-contrast: more)']) {
      window.matchMedia(query).addEventListener('change', () => this.settings.look === 'auto' && this.changeSettings(this.settings));
    }
    await this.identify();
    window.requestAnimationFrame(this.tick);
  }

  /** By the key in the address, or by the session that this browser has. */
  private async identify(): Promise<void> {
    const key = keyOf(window.location.hash);
    if (key !== undefined) {
      // Out of the address before anything else: it must not end up in a history or on a screenshot.
      window.history.replaceState(null, '', window.location.pathname);
    }
    try {
      const answer = key === undefined ? await this.api.session() : await this.api.logIn({ key });
      this.enter(answer);
    } catch (error) {
      this.askLogIn(error);
    }
  }

  private useSettings(): void {
    chooseLanguage(this.settings.language);
    chooseUnits(this.settings.units);
    applyLook(this.settings.look);
  }

  private changeSettings(settings: Settings): void {
    this.settings = settings;
    saveSettings(settings);
    this.useSettings();
    if (this.context) {
      this.context.settings = settings;
      this.build();
    }
  }

  private enter(answer: SessionAnswer): void {
    if (answer.session) {
      this.begin(answer.session);
    } else {
      this.showLogIn(answer);
    }
  }

  /** Nothing of a session goes on behind the log-in. */
  private leave(): void {
    this.stream?.close();
    this.closeView();
    document.querySelectorAll('dialog').forEach((d) => d.close());
    this.context = this.head = undefined;
  }

  private askLogIn(error: unknown): void {
    // A wrong key, or a server that is not there.
    this.leave();
    this.showLogIn(NO_SESSION, error instanceof ApiError ? error.message : t('no_connection'));
  }

  private showLogIn(answer: SessionAnswer, why = ''): void {
    this.host.replaceChildren(
      logInPage({ answer, why, settings: this.settings, logIn: async (by) => this.enter(await this.api.logIn(by)), change: (s) => this.changeLogIn(answer, s) }),
    );
  }

  private changeLogIn(answer: SessionAnswer, settings: Settings): void {
    this.changeSettings(settings);
    this.showLogIn(answer);
  }

  private loggedOut(why: string): void {
    if (!this.context) {
      // Said already: several answers may say so at once.
      return;
    }
    this.lost ??= this.heard;
    this.leave();
    void this.api
      .session()
      .then((answer) => this.showLogIn(answer, why))
      .catch(() => this.showLogIn(NO_SESSION, why));
  }

  private begin(session: Session): void {
    const live = new Live();
    const context: Context = {
      api: this.api,
      live,
      session,
      settings: this.settings,
      staged: new Staged(),
      machine: undefined,
      loadMachine: async () => (context.machine = (await this.api.get<{ machine: Machine }>('machine')).machine),
      say: (text, urgent) => this.toast.say(text, urgent),
    };
    this.context = context;
    this.mode = undefined;
    this.connection = { state: 'connecting' };
    this.build();
    this.connect(live);
  }

  private connect(live: Live): void {
    this.stream?.close();
    this.stream = new Stream({
      message: (message) => {
        if (live.take(message)) {
          this.head?.machine();
          if (this.context?.machine) {
            // Another one may be in force.
            this.context.machine = undefined;
          }
        }
        this.heard = Date.now();
        this.watchMode();
        if (message.type === 'frame') {
          this.sayItIsBack();
        }
      },
      up: () => (this.connection = { state: 'live' }),
      down: () => {
        this.lost ??= this.heard;
        if (this.connection.state !== 'down') {
          this.connection = { state: 'down', since: new Date() };
          this.toast.say(t('lost'), true);
        }
        this.head?.update(this.connection);
      },
      mayReconnect: async () => this.stillLoggedIn(),
    });
    this.stream.open();
  }

  /** After a restart of the server the session is gone. */
  private async stillLoggedIn(): Promise<boolean> {
    try {
      const { session } = await this.api.session();
      if (!session) {
        this.loggedOut(t('logged_out'));
      } else if (this.context) {
        const { name, role } = this.context.session;
        this.context.session = session;
        if (name !== session.name || role !== session.role) {
          this.build();
        }
      }
      return session !== null;
    } catch {
      return true;
    }
  }

  /** With the first frame after a break. */
  private sayItIsBack(): void {
    if (this.lost !== undefined) {
      this.toast.say(t('back', { seconds: ((Date.now() - this.lost) / 1000).toFixed(1) }), true);
      this.lost = undefined;
    }
  }

  private async logOut(): Promise<void> {
    try {
      await this.api.logOut();
    } catch (error) {
      // Whoever leaves the machine must know that the session goes on.
      this.toast.say(t('failed', { what: problemText(error) }), true);
      return;
    }
    this.loggedOut(t('logged_out'));
    // Whoever leaves misses nothing.
    this.heard = this.lost = undefined;
  }

  private watchMode(): void {
    const mode = this.context?.live.status?.mode;
    if (mode !== undefined && mode !== this.mode) {
      if (this.mode !== undefined) {
        this.toast.say(t('mode_changed', { mode: t(`mode_${mode}`) }));
      }
      this.mode = mode;
    }
  }

  /** The frame of all views; again after a change of language, units or look. */
  private build(): void {
    const { context } = this;
    if (!context) {
      return;
    }
    this.head = new Head(context);
    const main = h('main', { id: 'view', tabindex: -1 });
    const menu = nav(context, { change: (s) => this.changeSettings(s), logOut: () => void this.logOut() });
    const skip = h('a', { class: 'skip', href: '#view', onclick: (event) => { event.preventDefault(); main.focus(); } }, t('skip'));
    this.host.replaceChildren(skip, this.head.root, h('div', { class: 'second' }, menu, this.head.modes), main, stagedBar(context));
    this.head.machine();
    this.head.update(this.connection);
    this.openView();
  }

  private closeView(): void {
    this.view?.close?.();
    this.view = undefined;
  }

  private openView(): void {
    const { context } = this;
    if (!context) {
      return;
    }
    this.closeView();
    const { view, argument } = routeOf(window.location.hash);
    document.querySelectorAll<HTMLElement>('nav a').forEach((a) => (a.dataset['view'] === view ? a.setAttribute('aria-current', 'page') : a.removeAttribute('aria-current')));
    document.title = `${t(view)} – Steadyrest`;
    this.view = VIEWS[view](context, argument);
    const main = document.getElementById('view');
    main?.setAttribute('data-view', view);
    main?.replaceChildren(this.view.root);
    window.scrollTo(0, 0);
    this.view.redraw?.(theme());
    context.live.changed = true;
    this.figures = 0;
  }

  private readonly tick = (now: number): void => {
    window.requestAnimationFrame(this.tick);
    const { context } = this;
    // A little early is on time: the screen's next picture would be late.
    if (!context?.live.changed || now - this.drawn < FRAME_MS - 4) {
      return;
    }
    this.drawn = now;
    context.live.changed = false;
    const figures = now - this.figures >= FIGURES_MS;
    if (figures) {
      this.figures = now;
      this.head?.update(this.connection);
    }
    this.view?.update?.(theme(), figures);
  };
}
