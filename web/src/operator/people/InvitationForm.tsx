import { Button, Checkbox, SegmentedControl, TextInput } from "@mantine/core";
import { useState, type ReactNode } from "react";
import type { Role } from "../../app/session";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { type InvitedMessage, postPeopleInvitations } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { InvitationLink } from "./InvitationLink";

type Invited = InvitedMessage;

const ROLES: readonly Role[] = ["supervisor", "viewer", "screen", "camera", "operator"];
const WEEK_H = 168;
const HOURS = [1, 24, WEEK_H];

/** Form for an invitation: name, role, duration; then its link, once. */
export function InvitationForm({ onInvited }: { onInvited: () => void }): ReactNode {
  const all = useTexts();
  const texts = all.people;
  const [name, setName] = useState("");
  const [role, setRole] = useState<Role>("supervisor");
  const [hours, setHours] = useState(24);
  const [singleUse, setSingleUse] = useState(true);
  const [forMachine, setForMachine] = useState(false);
  const [invited, setInvited] = useState<Invited | null>(null);
  const { busy, rejection, run } = useAction();

  const invite = async (): Promise<void> => {
    const body = { name: name.trim(), role, lasts_h: hours, single_use: singleUse, for_machine: forMachine };
    setInvited(await postPeopleInvitations({ body }));
    setName("");
    onInvited();
  };
  if (invited !== null) {
    return (
      <InvitationLink
        invited={invited}
        onDone={() => {
          setInvited(null);
        }}
      />
    );
  }
  return (
    <section aria-labelledby="invite">
      <h3 id="invite">{texts.invite}</h3>
      <form
        onSubmit={(event) => {
          event.preventDefault();
          void run(invite);
        }}
      >
        <TextInput
          size="lg"
          label={texts.name}
          description={texts.nameHint}
          maxLength={80}
          value={name}
          onChange={(event) => {
            setName(event.currentTarget.value);
          }}
        />
        <div role="group" aria-label={texts.role}>
          <SegmentedControl
            size="lg"
            fullWidth
            aria-label={texts.role}
            data={ROLES.map((one) => ({ value: one, label: all.signIn.role[one] }))}
            value={role}
            onChange={setRole}
          />
          <p className="people-hint">{texts.lets[role]}</p>
        </div>
        <div className="people-row">
          <span>{texts.lasts}</span>
          <SegmentedControl
            size="lg"
            aria-label={texts.lasts}
            data={HOURS.map((one) => ({
              value: String(one),
              label: one === WEEK_H ? texts.week : `${String(one)} ${texts.hours}`,
            }))}
            value={String(hours)}
            onChange={(chosen) => {
              setHours(Number(chosen));
            }}
          />
        </div>
        <div className="people-row">
          <Checkbox
            size="lg"
            label={texts.singleUse}
            checked={singleUse}
            onChange={(event) => {
              setSingleUse(event.currentTarget.checked);
            }}
          />
          <Checkbox
            size="lg"
            label={texts.forMachine}
            checked={forMachine}
            onChange={(event) => {
              setForMachine(event.currentTarget.checked);
            }}
          />
        </div>
        <RejectionNote rejection={rejection} />
        <Button type="submit" size="lg" loading={busy} disabled={name.trim() === ""} data-testid="invite">
          {texts.make}
        </Button>
      </form>
    </section>
  );
}
