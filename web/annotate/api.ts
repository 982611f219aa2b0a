// Requests to the server that opened this page.

export class ApiError extends Error {
  constructor(
    readonly status: number,
    message: string,
  ) {
    super(message);
  }
}

/** The body of an error answer, or the status if it is not one of ours. */
async function failure(answer: Response): Promise<ApiError> {
  const text = await answer.text();
  try {
    return new ApiError(answer.status, String(JSON.parse(text).error));
  } catch {
    return new ApiError(answer.status, `the server answered ${answer.status}`);
  }
}

export const NO_ANSWER = "pcednet does not answer";

export class Api {
  /** This window's name at the server; what changes anything needs it. */
  window = "";
  /** The cloud that is looked at. */
  cloud = 0;

  constructor(private readonly token: string) {}

  private async ask(path: string, options: RequestInit = {}): Promise<Response> {
    const headers: Record<string, string> = { "X-Pcednet-Token": this.token };
    if (this.window) headers["X-Window"] = this.window;
    if (options.body) headers["Content-Type"] = "application/json";
    const place = options.method ? path : this.inView(path);
    const answer = await fetch(place, { ...options, headers, cache: "no-store" }).catch(() => {
      throw new Error(NO_ANSWER);
    });
    if (!answer.ok) throw await failure(answer);
    return answer;
  }

  async get<T>(path: string): Promise<T> {
    return (await this.ask(path)).json() as Promise<T>;
  }

  async post<T>(path: string, body: unknown = {}): Promise<T> {
    return (await this.ask(path, { method: "POST", body: JSON.stringify(body) })).json() as Promise<T>;
  }

  async bytes(path: string): Promise<ArrayBuffer> {
    return (await this.ask(path)).arrayBuffer();
  }

  private inView(path: string): string {
    return this.cloud === 0 ? path : `${path}${path.includes("?") ? "&" : "?"}cloud=${this.cloud}`;
  }

  /** The window closes: another one may paint. */
  leave(): void {
    if (this.window) navigator.sendBeacon(this.address(`/api/window/${this.window}/leave`));
  }

  /** An address that a link or an event source can open. */
  address(path: string): string {
    const whole = this.inView(path);
    return `${whole}${whole.includes("?") ? "&" : "?"}token=${encodeURIComponent(this.token)}`;
  }

  /** Calls `on[name]` for each event; reconnects by itself and then calls `on.open`. */
  events(on: Record<string, (data: any) => void>): EventSource {
    const source = new EventSource(this.address(`/api/events?window=${this.window}`));
    for (const [name, handle] of Object.entries(on)) {
      source.addEventListener(name, (event) => {
        const text = (event as MessageEvent).data;
        handle(text ? JSON.parse(text) : {});
      });
    }
    return source;
  }
}
