import { afterEach, expect, test, vi } from "vitest";
import { getCases, getCtSlicesByPlane, getLive, postCases, postPlanImport } from "../api";
import { NO_ANSWER, onSessionGone, Rejection } from "./client";

const PROBLEM = { code: "NO_CT", message: "no CT", remedy: "Send one.", context: {}, language: "en" };

const json = (content: unknown, status = 200): Response =>
  new Response(JSON.stringify(content), { status, headers: { "Content-Type": "application/json" } });

/** Lets the server answer each request so; the returned array has what was requested. */
function serverAnswers(answer: (request: Request) => Response): Request[] {
  const requests: Request[] = [];
  vi.stubGlobal("fetch", async (request: Request) => {
    requests.push(request);
    request.signal.throwIfAborted();
    return Promise.resolve(answer(request));
  });
  return requests;
}

/** The rejection of a request that must not succeed. */
async function rejectionOf(request: Promise<unknown>): Promise<Rejection> {
  const reason = await request.then(
    () => null,
    (error: unknown) => error,
  );
  if (!(reason instanceof Rejection)) throw new Error(`not a rejection: ${String(reason)}`);
  return reason;
}

afterEach(() => {
  vi.unstubAllGlobals();
});

test("a request states address, query and language, is never stored, and resolves to the body", async () => {
  const requests = serverAnswers(() => json({ at_mm: 1.5 }));
  const body = await getCtSlicesByPlane({ path: { plane: "axial" }, query: { at_mm: 1.5, pixel_mm: 0.5 } });
  expect(body).toEqual({ at_mm: 1.5 });
  const [request] = requests;
  expect(request?.url).toBe("http://127.0.0.1/api/ct/slices/axial?at_mm=1.5&pixel_mm=0.5");
  expect(request?.cache).toBe("no-store");
  expect(request?.headers.get("Accept-Language")).toBe("en");
});

test("a body is sent as JSON", async () => {
  const requests = serverAnswers(() => json({ id: "1" }));
  await postCases({ body: { name: "a" } });
  expect(requests[0]?.headers.get("Content-Type")).toBe("application/json");
  expect(await requests[0]?.json()).toEqual({ name: "a" });
});

test("a file of JSON is sent as it is", async () => {
  const requests = serverAnswers(() => json({}));
  await postPlanImport({ body: '{"format": 1 }', bodySerializer: null });
  expect(requests[0]?.headers.get("Content-Type")).toBe("application/json");
  expect(await requests[0]?.text()).toBe('{"format": 1 }');
});

test("a rejected request throws the server's problem and the status", async () => {
  serverAnswers(() => json(PROBLEM, 409));
  const { problem, status } = await rejectionOf(getCases());
  expect(problem).toEqual(PROBLEM);
  expect(status).toBe(409);
});

test("an error page of a proxy is no answer of the server, and its status is kept", async () => {
  serverAnswers(() => new Response("<h1>Bad gateway</h1>", { status: 502 }));
  const { problem, status } = await rejectionOf(getCases());
  expect(problem).toEqual({ ...NO_ANSWER, context: { status: 502 } });
  expect(status).toBe(502);
});

test.each([
  ["a connection that is lost", new TypeError("Failed to fetch")],
  ["a server that takes too long", new DOMException("", "TimeoutError")],
])("%s is no answer", async (_, error) => {
  serverAnswers(() => {
    throw error;
  });
  const { problem, status } = await rejectionOf(getCases());
  expect(problem).toEqual(NO_ANSWER);
  expect(status).toBeNull();
});

test("a body that was cut off is no answer", async () => {
  const headers = { "Content-Type": "application/json" };
  serverAnswers(() => new Response('{"cases": [', { headers }));
  expect((await rejectionOf(getCases())).status).toBeNull();
});

test("an aborted request is no rejection", async () => {
  serverAnswers(() => json({}));
  await expect(getLive({ signal: AbortSignal.abort() })).rejects.toMatchObject({ name: "AbortError" });
});

test("only an answer 401 ends the session", async () => {
  let ended = 0;
  const stop = onSessionGone(() => {
    ended += 1;
  });
  const statuses = [403, 401];
  serverAnswers(() => json(PROBLEM, statuses.shift() ?? 200));
  await rejectionOf(getCases());
  expect(ended).toBe(0);
  await rejectionOf(getCases());
  expect(ended).toBe(1);
  stop();
});
