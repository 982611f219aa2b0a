// Keeps the page's state in step with the server's.

import { ApiError, NO_ANSWER, type Api } from "./api";
import { usableRadius } from "./brush_size";
import { paintable, usableClass, type WantedClass } from "./classes";
import { Files } from "./files";
import { modesOf, PREDICTED } from "./modes";
import { LineClient } from "./line_client";
import { NOTHING_PAINTED, refusalOf } from "./refusal";
import type { Stage } from "./stage";
import type { AppStore } from "./store";
import { withEpoch } from "./training";
import type {
  DecidedEvent,
  Classes,
  LinesEvent,
  Painted,
  PredictionEvent,
  Run,
  Session,
  Settings,
  Stroke,
  TrainingEvent,
} from "./types";
import { UncertainClient } from "./uncertain_client";
import { resumed, viewOf, type CloudView } from "./views";
import { ask, type Words } from "./words";
import { LONGEST_PAUSE_MS, pause, WorkQueue } from "./work";

export class Client {
  private readonly queue: WorkQueue;
  readonly lines: LineClient;
  readonly files: Files;
  readonly uncertain: UncertainClient;
  private events: EventSource | null = null;
  private opened = false;
  /** Of any cloud: what the user chose since then stays. */
  private wasOpened = false;
  /** The program is computing what it needs to answer. */
  private loading = true;
  /** The newest labels that this start of the program told of. */
  private labelsVersion = 0;
  /** How often it told of what a session holds: one that was asked for before may be older. */
  private heard = 0;
  /** Events were not heard for a while. */
  private missed = false;
  /** As the user chose, whatever starts were chosen since: one that knows no smooth edges learns two. */
  private wishedClasses: 2 | 3 | null = null;
  /** The start whose description the session told of. */
  private described = "";
  /** The last look at the session, done or not. */
  private looked: Promise<void> = Promise.resolve();
  /** Of the clouds that were looked at before. */
  private readonly views = new Map<number, CloudView>();
  stage!: Stage;
  /** Before another cloud is looked at. */
  leaving: () => void = () => {};

  constructor(
    private readonly api: Api,
    private readonly store: AppStore,
    private readonly words: Words,
  ) {
    this.lines = new LineClient(api, store, words, () => this.mayPaint(), ask);
    this.files = new Files(api, store, words);
    this.uncertain = new UncertainClient(api, store, words);
    this.queue = new WorkQueue(api, {
      painted: (answer, kind) => {
        this.takePainted(answer);
        const { cloud, clouds } = this.store.now;
        if (kind !== "stroke" && answer.cloud !== cloud && answer.nodes.length > 0) {
          this.words.say(`That was in ${clouds[answer.cloud].file}.`);
        }
      },
      failed: (message) => {
        this.words.warn(message);
        this.stage.loader.takeBack();
        this.stage.loader.refresh("labels");
      },
      waits: (waiting) => this.store.set({ waiting }),
      isOpen: () => this.store.now.connected && !this.loading,
      steps: () => this.store.now,
      askSteps: async () => {
        const session = await this.api.get<Session>("/api/session");
        if (session.state !== "ready") throw new Error("it is still loading");
        return session;
      },
      idle: () => this.stage.loader.resume(),
    });
    store.watch(["classes", "edges", "counts", "settings"], () => {
      if (store.now.classes.length > 0) store.set({ paintClass: usableClass(store.now) });
    });
    store.watch(["radius"], () => {
      const { session, radius } = store.now;
      if (session) store.set({ brush: radius / session.spacing });
    });
  }

  get isBusy(): boolean {
    return this.queue.isBusy;
  }

  /** Opens this window at the server; reports what goes wrong. */
  async start(): Promise<void> {
    await this.enter();
    this.listen();
    await this.refresh();
  }

  private async enter(): Promise<void> {
    const { window: name, writer } = await this.api.post<{ window: string; writer: boolean }>("/api/window");
    this.api.window = name;
    this.store.set({ writer });
    // A window that only looked on may be back earlier: the strokes that wait here are not lost to it.
    if (!writer && this.isBusy) await this.paintHere();
  }

  private async paintHere(): Promise<void> {
    await this.api.post(`/api/window/${this.api.window}/take`);
    this.store.set({ writer: true });
  }

  /** The program answers again, or another start of it does. */
  private async returned(): Promise<void> {
    this.missed = true;
    if (!(await this.ask())) return;
    this.store.set({ connected: true });
    for (const text of [NO_ANSWER, NOTHING_PAINTED]) this.words.unsay(text);
  }

  /** Asks for the session until it is answered, for no further event would come; false if the program is gone. */
  private async ask(): Promise<boolean> {
    for (let wait = 100; this.events?.readyState === EventSource.OPEN; wait = Math.min(2 * wait, LONGEST_PAUSE_MS)) {
      try {
        await this.refresh();
        return true;
      } catch (error) {
        if (error instanceof ApiError) throw error;
        await pause(wait);
      }
    }
    return false;
  }

  private listen(): void {
    const { store } = this;
    this.events = this.api.events({
      progress: ({ stage, fraction }) => {
        if (this.loading) store.set({ progress: { stage, fraction } });
        else this.lines.takeStage(stage, fraction);
      },
      ready: () => this.attempt(this.ask()),
      labels: (answer: Painted) => this.takePainted(answer),
      training: (event: TrainingEvent) => store.set({ training: withEpoch(store.now.training, event) }),
      prediction: (event: PredictionEvent) => this.attempt(this.takePrediction(event)),
      judged: () => this.attempt(this.refreshRuns()),
      classes: (event: Classes) => {
        const { edges } = store.now;
        ++this.heard;
        this.takeClasses(event);
        if (edges !== event.edges) this.attempt(this.beginAnew());
      },
      lines: (event: LinesEvent) => this.attempt(this.lines.take(event)),
      decided: (event: DecidedEvent) => this.lines.takeDecisions(event),
      writer: ({ window: name }) => store.set({ writer: name === this.api.window }),
      problem: ({ message }) => {
        this.endTraining();
        this.words.warn(message);
        if (this.opened) this.attempt(this.refreshRuns());
      },
    });
    // A source that is closed was refused: another start of the program, with another token, is there now.
    this.events.addEventListener("error", () => {
      const restarted = this.events?.readyState === EventSource.CLOSED;
      if (restarted) this.queue.giveUp();
      store.set({ connected: false, restarted });
    });
    this.events.addEventListener("open", () => {
      if (!this.opened) this.attempt(this.refresh()); // what happened before this was not heard
      this.attempt(store.now.connected ? this.lookWhoPaints() : this.returned());
    });
  }

  /** The window that painted may have left before this one heard of anything. */
  private async lookWhoPaints(): Promise<void> {
    const { known, writer } = await this.api.get<Session>("/api/session");
    if (known && writer) this.store.set({ writer });
  }

  /** The session as it is now. One look at it after another: two at a time would open two windows. */
  private refresh(): Promise<void> {
    this.looked = this.looked.catch(() => {}).then(() => this.takeSession());
    return this.looked;
  }

  /** The session, not older than what was heard of while it was on its way. */
  private async getSession(): Promise<Session> {
    for (;;) {
      const { heard } = this;
      const session = await this.api.get<Session>("/api/session");
      if (session.known && heard !== this.heard) continue;
      this.labelsVersion = session.labels_version;
      return session;
    }
  }

  /** The first time that it is ready, the cloud too. */
  private async takeSession(): Promise<void> {
    const session = await this.getSession();
    const { store } = this;
    if (!session.known) await this.enter();
    else if (this.missed) store.set({ writer: session.writer });
    this.loading = session.state !== "ready";
    if (this.loading) {
      if (!store.now.progress?.fraction) store.set({ progress: { stage: session.stage, fraction: 0 } });
      return;
    }
    // Another version of the program may cut the cloud in other parts.
    if (this.opened && JSON.stringify(store.now.session?.nodes) !== JSON.stringify(session.nodes)) location.reload();
    store.set({
      session,
      clouds: session.clouds,
      cloud: session.cloud,
      settings: session.settings,
      undo: session.undo,
      redo: session.redo,
      outOfDate: session.out_of_date,
      predictionVersion: session.prediction_version,
      scale: Math.max(0, Math.min(store.now.scale, session.scales.length - 1)),
    });
    this.takeClasses(session);
    const runs = await this.api.get<Run[]>("/api/runs");
    store.set({ runs, progress: null });
    await this.lines.refresh();
    this.described = session.settings.start;
    if (this.opened) {
      if (this.missed) this.catchUp();
      return;
    }
    this.opened = true;
    // A prediction may have come after the session was asked for.
    const hasPrediction = store.now.hasPrediction || (session.prediction_version > 0 && session.run !== null);
    const usual = hasPrediction ? "prediction" : session.has_colours ? "rgb" : "labels";
    const first = !this.wasOpened;
    this.wasOpened = true;
    const view = this.views.get(session.cloud);
    store.set({
      radius: usableRadius(session.spacing * store.now.brush, session),
      mode: first || !modesOf(store).includes(store.now.mode) ? usual : store.now.mode,
      ...(first ? { scale: Math.floor(session.scales.length / 2) } : {}),
      hasPrediction,
      ...resumed(view, store.now),
    });
    store.set({ fetching: true });
    this.stage.open(session, hasPrediction, view?.pose);
    if (!view) for (const note of session.notes) this.words.warn(note);
    if (store.now.mode === "feature") this.stage.loader.refresh("values");
  }

  private takeClasses({ classes, edges }: Classes): void {
    const { store } = this;
    const counts = classes.map((one) => one.count);
    store.set({ classes, edges, counts });
  }

  /** Other classes than those of the start, or those again: what it found is of no use. */
  private async beginAnew(): Promise<void> {
    const { store } = this;
    if (PREDICTED.includes(store.now.mode)) store.set({ mode: "labels" });
    store.set({
      hasPrediction: false,
      uncertain: null,
      hidden: new Set(),
      paintClass: paintable(store.now)[store.now.edges ? 2 : 0].id,
    });
    await this.refresh();
    this.stage.loader.refresh("prediction");
  }

  /** Throws what the program says against it. */
  async setClasses(classes: WantedClass[]): Promise<void> {
    await this.api.post("/api/classes", { classes });
  }

  private catchUp(): void {
    this.missed = false;
    this.stage.loader.refresh("labels");
    if (this.store.now.predictionVersion > 0) this.stage.loader.refresh("prediction");
  }

  private async refreshRuns(): Promise<void> {
    this.store.set({ runs: await this.api.get<Run[]>("/api/runs") });
  }

  private endTraining(): void {
    const { training } = this.store.now;
    if (training?.active) this.store.set({ training: { ...training, active: false } });
  }

  private attempt(work: Promise<unknown>): void {
    work.catch((error: Error) => this.words.warn(error.message));
  }

  private takePainted(answer: Painted): void {
    const { store } = this;
    ++this.heard;
    // An answer may come after that to a later stroke.
    if (answer.labels_version >= this.labelsVersion) {
      this.labelsVersion = answer.labels_version;
      const clouds = store.now.clouds.map((its, k) => ({ ...its, painted: answer.painted[k] }));
      store.set({ clouds, counts: answer.counts, undo: answer.undo, redo: answer.redo });
    }
    if (answer.nodes.length > 0) store.set({ outOfDate: true });
    if (answer.cloud === store.now.cloud) this.stage.loader.refresh("labels", answer.nodes);
  }

  private async takePrediction(event: PredictionEvent): Promise<void> {
    const { store } = this;
    const first = !store.now.hasPrediction;
    ++this.heard;
    this.endTraining();
    store.set({
      hasPrediction: true,
      uncertain: null,
      predictionVersion: event.prediction_version,
      outOfDate: event.out_of_date,
    });
    this.stage.loader.refresh("prediction");
    if (["errors", "confidence", "p_sharp"].includes(store.now.mode)) this.stage.loader.refresh("values");
    if (first && ["labels", "rgb"].includes(store.now.mode)) store.set({ mode: "prediction" });
    if (store.now.settings.start === this.described) await this.refreshRuns();
    else await this.refresh(); // other scales
    if (store.now.mode === "feature") this.stage.loader.refresh("values");
  }

  paint(stroke: Stroke): void {
    this.queue.stroke({ ...stroke, cloud: this.store.now.cloud });
  }

  /** Looks at another cloud. */
  look(cloud: number): void {
    const { store } = this;
    if (cloud === store.now.cloud || !store.now.clouds[cloud] || store.now.progress) return;
    this.leaving();
    this.views.set(store.now.cloud, viewOf(store.now, this.stage.camera.pose));
    this.api.cloud = cloud;
    store.set({
      uncertain: null,
      clip: null,
      measured: [],
      progress: { stage: `Opening ${store.now.clouds[cloud].file}`, fraction: 0 },
    });
    this.stage.close();
    this.opened = false;
    this.attempt(this.refresh());
  }

  /** Whether this window paints; says so if it does not. */
  private mayPaint(): boolean {
    const refusal = refusalOf(this.store.now);
    if (refusal) this.words.warn(refusal);
    return !refusal;
  }

  undo(): void {
    if (!this.mayPaint()) return;
    if (this.store.now.undo > 0 || this.isBusy) this.queue.undo();
  }

  redo(): void {
    if (!this.mayPaint()) return;
    if (this.store.now.redo > 0 || this.isBusy) this.queue.redo();
  }

  setSettings(changes: Partial<Settings>): void {
    const before = this.store.now.settings;
    this.wishedClasses = changes.classes ?? this.wishedClasses ?? before.classes;
    const wanted = { ...before, ...(changes.start ? { classes: this.wishedClasses } : {}), ...changes };
    this.store.set({ settings: wanted });
    this.attempt(
      this.api
        .post<Settings>("/api/settings", wanted)
        .then((settings) => {
          ++this.heard;
          this.store.set({ settings });
          if (settings.classes < wanted.classes) {
            this.words.say(`Model ${settings.start} knows no smooth edges: it learns two classes.`);
          }
        })
        .catch((error: Error) => {
          this.store.set({ settings: before });
          throw error;
        }),
    );
  }

  train(): void {
    this.attempt(this.api.post("/api/train"));
  }

  cancel(): void {
    this.endTraining();
    this.attempt(this.api.post("/api/cancel").then(() => this.refreshRuns()));
  }

  restore(run: number): void {
    this.attempt(this.api.post(`/api/runs/${run}/restore`).then(() => this.refreshRuns()));
  }

  takeOver(): void {
    this.attempt(this.paintHere());
  }
}
