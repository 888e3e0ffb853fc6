import type { ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";
import { lookText, shortLookText } from "./lookText";
import type { ConnectionState, PageLook, Person } from "./messages";
import { personName, roleBeside } from "./personName";
import { useRoomSnapshot } from "./RoomContext";

const SYMBOL: Record<ConnectionState, string> = { good: "●", slow: "◐", silent: "▲" };

/** The viewers: number, names, what they see, roles and connection quality. */
export function Viewers(): ReactNode {
  const all = useTexts();
  const { room: texts, rest } = all;
  const { isConnected, firstMessage, people } = useRoomSnapshot();
  if (!isConnected) {
    return (
      <p className="watching" data-testid="watching" data-known="false">
        {firstMessage === "awaited" ? rest.loading : texts.unknown}
      </p>
    );
  }
  return (
    <div className="watching" data-testid="watching" data-known="true">
      <p className="watching-count">
        {texts.watching} <strong>{people.length}</strong>
      </p>
      <ul>
        {people.map((one) => (
          <li key={`${one.name} ${one.role} ${one.since}`} data-line={one.line}>
            <span aria-hidden="true" className="watching-line">
              {SYMBOL[one.line]}
            </span>{" "}
            <b>{personName(one.name, all)}</b>{" "}
            {!one.is_you && <Looks pages={pageInFront(one)} text={(page) => shortLookText(page, all)} />}{" "}
            <span className="watching-role">{roleBeside(one.name, texts.role[one.role], all)}</span>
            {one.is_you && <span className="watching-role"> · {texts.you}</span>}
            {/* Seen by its symbol and colour: words that come and go would move the page. */}
            {one.line !== "good" && <em className="heard-only"> · {texts.line[one.line]}</em>}
          </li>
        ))}
      </ul>
    </div>
  );
}

/** What each viewer sees, one page a line: whether others see the same, and whether it is live. */
export function ViewerLooks(): ReactNode {
  const all = useTexts();
  const { isConnected, people } = useRoomSnapshot();
  const texts = all.room;
  if (!isConnected) return <p className="watching-role">{texts.unknown}</p>;
  return (
    <ul className="looks" aria-label={texts.what} data-testid="looks">
      {people.map((one) => (
        <li key={`${one.name} ${one.role} ${one.since}`}>
          <b>{personName(one.name, all)}</b>{" "}
          <span className="watching-role">{roleBeside(one.name, texts.role[one.role], all)}</span>
          {one.is_you && <span className="watching-role"> · {texts.you}</span>}
          {one.line !== "good" && <em> · {texts.line[one.line]}</em>}
          <Looks pages={one.pages} text={(page) => lookText(page, all)} />
        </li>
      ))}
    </ul>
  );
}

/** The page in front, or the first one. */
function pageInFront({ pages }: Person): readonly PageLook[] {
  const page = pages.find((one) => one.freshness !== "hidden") ?? pages[0];
  return page === undefined ? [] : [page];
}

interface LooksProps {
  pages: readonly PageLook[];
  text: (page: PageLook) => string;
}

function Looks({ pages, text }: LooksProps): ReactNode {
  return pages.map((page) => {
    const said = text(page);
    return (
      <span key={`${page.view} ${said}`} className="watching-look" data-freshness={page.freshness}>
        {said}
      </span>
    );
  });
}
