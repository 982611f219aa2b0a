// Brings nodes from the server in the order wanted, and keeps their layers up to date.

import type { Api } from "./api";
import { decodeChunk, type Chunk } from "./chunk";
import type { Layer } from "./painter";
import type { NodeInfo } from "./types";

/** What the values of a query are, without the scale and the like: those of another scale show until the new are here. */
export const kindOf = (query: string | null): string | null => new URLSearchParams(query ?? "").get("of");

const AT_ONCE = 4;
const BATCH_POINTS = 2_000_000;

export interface LoaderEvents {
  arrived(chunk: Chunk): void;
  dropped(id: number): void;
  /** Layers of some nodes differ from what was here. */
  changed(ids: number[], layer: Layer): void;
  failed(error: Error): void;
  /** While strokes are under way labels from the server would wipe them out. */
  isPainting(): boolean;
}

export class Loader {
  readonly chunks = new Map<number, Chunk>();
  nodes: ReadonlyMap<number, NodeInfo> = new Map();
  private hasColours = false;
  private hasPrediction = false;
  private valuesOf: string | null = null;
  private wanted: number[] = [];
  private loading = new Set<number>();
  private readonly stale: Record<Layer, Set<number>> = { labels: new Set(), prediction: new Set(), values: new Set() };
  private readonly refreshing: Record<Layer, boolean> = { labels: false, prediction: false, values: false };
  private kept = 0;
  /** So many points are kept: what is looked at, and some of what was. */
  mostPoints = 4_000_000;

  constructor(
    private readonly api: Api,
    private readonly on: LoaderEvents,
  ) {}

  /** Forgets the cloud, and what is still on its way. */
  reset(): void {
    for (const id of this.chunks.keys()) this.on.dropped(id);
    this.chunks.clear();
    this.nodes = new Map();
    this.loading = new Set();
    this.wanted = [];
    this.kept = 0;
    Object.values(this.stale).forEach((ids) => ids.clear());
  }

  setNodes(nodes: ReadonlyMap<number, NodeInfo>, hasColours: boolean, hasPrediction: boolean): void {
    this.nodes = nodes;
    this.hasColours = hasColours;
    this.hasPrediction = hasPrediction;
  }

  /** The nodes to draw, most wanted first; those not here are fetched. */
  want(ids: number[]): void {
    for (const id of ids) {
      const chunk = this.chunks.get(id);
      if (!chunk) continue;
      this.chunks.delete(id); // to the end: used last
      this.chunks.set(id, chunk);
    }
    this.wanted = ids.filter((id) => !this.chunks.has(id) && !this.loading.has(id));
    this.pump();
  }

  get isLoading(): boolean {
    return this.loading.size > 0 || this.wanted.length > 0 || Object.values(this.refreshing).includes(true);
  }

  private pump(): void {
    while (this.loading.size < AT_ONCE && this.wanted.length > 0) {
      const id = this.wanted.shift()!;
      const { loading } = this;
      loading.add(id);
      this.load(id)
        .catch((error) => this.on.failed(error))
        .finally(() => {
          loading.delete(id);
          this.pump();
        });
    }
  }

  private async load(id: number): Promise<void> {
    const { nodes } = this;
    const info = nodes.get(id)!;
    const chunk = decodeChunk(info, await this.api.bytes(`/api/node/${id}/points`), this.hasColours);
    const layers: Layer[] = ["labels"];
    if (this.hasPrediction) layers.push("prediction");
    if (this.valuesOf) layers.push("values");
    const asked = this.valuesOf;
    await Promise.all(
      layers.map(async (layer) => {
        const bytes = new Uint8Array(await this.api.bytes(`/api/node/${id}/values?${this.query(layer)}`));
        if (bytes.length !== info.points) return;
        chunk[layer].set(bytes);
        if (layer === "labels") chunk.confirmed.set(bytes);
        if (layer === "values") chunk.valuesOf = kindOf(asked);
      }),
    );
    if (nodes !== this.nodes) return; // of a cloud that is not looked at any more
    this.chunks.set(id, chunk);
    this.kept += info.points;
    this.evict();
    this.on.arrived(chunk);
    if (asked !== this.valuesOf) this.refresh("values", [id]);
    for (const layer of ["labels", "prediction"] as Layer[]) {
      if (this.stale[layer].has(id)) void this.update(layer);
    }
  }

  private query(layer: Layer): string {
    return layer === "values" ? this.valuesOf! : `of=${layer}`;
  }

  private evict(): void {
    const wanted = new Set(this.wanted);
    for (const [id, chunk] of this.chunks) {
      if (this.kept <= this.mostPoints) return;
      if (id === 0 || wanted.has(id)) continue;
      this.chunks.delete(id);
      this.kept -= chunk.info.points;
      this.on.dropped(id);
    }
  }

  /** What the ramp shows from now on: a query as `of=confidence`; null is nothing. */
  setValues(query: string | null): void {
    if (query === this.valuesOf) return;
    this.valuesOf = query;
    this.stale.values.clear();
    if (query) this.refresh("values");
  }

  /** A layer has a new version, of some nodes or of all. */
  refresh(layer: Layer, ids: Iterable<number> = this.nodes.keys()): void {
    if (layer === "prediction") this.hasPrediction = true;
    if (layer === "values" && !this.valuesOf) return;
    for (const id of ids) this.stale[layer].add(id);
    void this.update(layer);
  }

  private async update(layer: Layer): Promise<void> {
    if (this.refreshing[layer]) return;
    this.refreshing[layer] = true;
    try {
      for (;;) {
        if (layer === "labels" && this.on.isPainting()) return;
        if (layer === "values" && !this.valuesOf) return;
        const batch = this.batch(layer);
        if (batch.length === 0) return;
        const query = this.query(layer);
        const { nodes } = this;
        const bytes = await this.api.bytes(`/api/values?${query}&nodes=${batch.map((c) => c.info.id).join(",")}`);
        if (nodes !== this.nodes) continue;
        const usable = layer === "labels" ? !this.on.isPainting() : this.query(layer) === query;
        if (usable) this.take(layer, batch, new Uint8Array(bytes));
        else batch.forEach((c) => this.stale[layer].add(c.info.id));
      }
    } catch (error) {
      this.on.failed(error as Error);
    } finally {
      this.refreshing[layer] = false;
    }
  }

  /** Stale chunks for one request, those drawn last first. */
  private batch(layer: Layer): Chunk[] {
    const stale = this.stale[layer];
    const batch: Chunk[] = [];
    let points = 0;
    for (const id of [...stale].sort((a, b) => a - b)) {
      if (points > BATCH_POINTS || batch.length >= 100) break;
      if (!this.loading.has(id)) stale.delete(id);
      const chunk = this.chunks.get(id);
      if (!chunk) continue;
      stale.delete(id);
      points += chunk.info.points;
      batch.push(chunk);
    }
    return batch;
  }

  private take(layer: Layer, batch: Chunk[], bytes: Uint8Array): void {
    const changed: number[] = [];
    let at = 0;
    for (const chunk of batch) {
      const now = bytes.subarray(at, (at += chunk.info.points));
      const old = chunk[layer];
      if (now.length !== old.length) throw new Error(`node ${chunk.info.id}: ${now.length} values, not ${old.length}`);
      if (layer === "labels") chunk.confirmed.set(now);
      const isNew = layer === "values" && chunk.valuesOf !== kindOf(this.valuesOf);
      if (isNew) chunk.valuesOf = kindOf(this.valuesOf);
      if (!isNew && now.every((value, i) => value === old[i])) continue;
      old.set(now);
      changed.push(chunk.info.id);
    }
    if (changed.length > 0) this.on.changed(changed, layer);
  }

  /** Strokes were lost: the labels are those that the server confirmed. */
  takeBack(): void {
    const changed = [...this.chunks.values()].filter((c) => c.labels.some((label, i) => label !== c.confirmed[i]));
    changed.forEach((chunk) => chunk.labels.set(chunk.confirmed));
    if (changed.length > 0)
      this.on.changed(
        changed.map((c) => c.info.id),
        "labels",
      );
  }

  /** Strokes are done: labels may be fetched again. */
  resume(): void {
    void this.update("labels");
  }
}
