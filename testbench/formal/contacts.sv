// SPDX-License-Identifier: MIT OR Apache-2.0
// Several bodies around the core for one: no place is taken twice; frames go to the core, are looked at and leave in
// the order in which they came, each once; no frame is in the core while those of bodies are, and each answer is taken
// for what it is of; and what is done with a frame comes to an end.
//
// The core is a queue that answers what it has been given whole, in order, when it likes. What counts bodies, keeps
// forces, parts them, makes frames and records, and sends the words out may be as slow as it likes, and does what it
// was told to once. Two places and two bodies.
module harness (
    input wire clock,
    input wire reset,
    input wire s_tvalid,
    input wire s_tlast,
    input wire core_s_tready,
    input wire core_m_tvalid,
    input wire [31:0] core_m_tdata,
    input wire core_m_tlast
);

    localparam BANKS = 2;
    localparam CONTACTS = 2;
    localparam [3:0] IDLE = 4'd0, LARGEST = 4'd1, COUNTS = 4'd2, WAITS = 4'd3, LOADS = 4'd4, DRAINS = 4'd5;
    localparam [3:0] PARTS = 4'd6, SENDS = 4'd7, ADDS = 4'd8, RECORDS = 4'd9, LEAVES = 4'd10;

    wire s_tready, core_s_tvalid, core_s_tlast;
    wire there, next, count_start, counted, parted, several, load_start, load_valid, loads, settled, hold;
    wire core_is_empty, with_bodies, is_second, part_start, part_done, send_start, sent, record_start, record_done;
    wire output_idle, parted_tvalid, parted_tlast, frame_done;
    wire [3:0] kept, body, answering, state, answered, header_address;
    wire begins, copies, header_there, is_counted, is_parted, reads, has_place, sends, valid, last;
    wire [1:0] cycle;
    wire [1:0] used, waiting, unanswered, looked_at;
    wire newest, oldest, newest_answer, turn;

    sptfra_contacts subject (
        .clock         (clock),
        .reset         (reset),
        .s_tvalid      (s_tvalid),
        .s_tready      (s_tready),
        .s_tlast       (s_tlast),
        .core_s_tvalid (core_s_tvalid),
        .core_s_tready (core_s_tready),
        .core_s_tlast  (core_s_tlast),
        .core_m_tvalid (core_m_tvalid),
        .core_m_tdata  (core_m_tdata),
        .core_m_tlast  (core_m_tlast),
        // Inside
        .there         (there),
        .next          (next),
        .count_start   (count_start),
        .counted       (counted),
        .parted        (parted),
        .kept          (kept),
        .several       (several),
        .load_start    (load_start),
        .load_valid    (load_valid),
        .loads         (loads),
        .settled       (settled),
        .hold          (hold),
        .core_is_empty (core_is_empty),
        .with_bodies   (with_bodies),
        .is_second     (is_second),
        .part_start    (part_start),
        .part_done     (part_done),
        .send_start    (send_start),
        .body          (body),
        .sent          (sent),
        .answering     (answering),
        .record_start  (record_start),
        .record_done   (record_done),
        .output_idle   (output_idle),
        .parted_tvalid (parted_tvalid),
        .parted_tlast  (parted_tlast),
        .frame_done    (frame_done),
        .\turns.state  (state),
        .\turns.begins (begins),
        .\turns.cycle  (cycle),
        .\turns.copies (copies),
        .\turns.header_there (header_there),
        .\turns.header_address (header_address),
        .\turns.is_counted (is_counted),
        .\turns.is_parted (is_parted),
        .\turns.reads  (reads),
        .\turns.answered (answered),
        .\intake.used  (used),
        .\intake.has_place (has_place),
        .\intake.newest (newest),
        .\intake.waiting (waiting),
        .\intake.oldest (oldest),
        .\intake.sends (sends),
        .\intake.valid (valid),
        .\intake.last (last),
        .\intake.unanswered (unanswered),
        .\answers.newest (newest_answer),
        .\answers.turn (turn),
        .\answers.waiting (looked_at)
    );

    // ---- Numbers of frames that have come, gone to the core, been answered, been looked at and left
    reg started = 1'b0;
    reg [2:0] came, went, were_answered, were_looked_at, left;
    wire comes = s_tvalid && s_tready && s_tlast;
    wire goes = core_s_tvalid && core_s_tready && core_s_tlast;
    wire is_answered = core_m_tvalid && core_m_tlast;
    wire [2:0] here = came - left;
    wire [2:0] to_go = came - went;
    wire [2:0] gone = went - were_answered;
    wire [2:0] to_look_at = were_answered - were_looked_at;
    wire [2:0] to_leave = were_looked_at - left;
    wire leaves = (to_leave != 3'd0);
    // ---- What the core has: frames, or frames of bodies
    reg [1:0] frames, bodies;
    // ---- What has been begun and is not done
    reg counting, parting, recording, making, sending;
    reg [3:0] settling; // fields whose last word has been given
    reg [3:0] kept_before;
    wire last_read = loads && load_valid && !reads;

    always @(posedge clock) begin
        started <= 1'b1;
        came <= came + {2'd0, comes};
        went <= went + {2'd0, goes && !with_bodies};
        were_answered <= were_answered + {2'd0, is_answered && (frames != 2'd0)};
        were_looked_at <= were_looked_at + {2'd0, next};
        left <= left + {2'd0, frame_done};
        frames <= frames + {1'b0, goes && !with_bodies} - {1'b0, is_answered && (frames != 2'd0)};
        bodies <= bodies + {1'b0, goes && with_bodies} - {1'b0, is_answered && (frames == 2'd0)};
        counting <= count_start || (counting && !counted);
        parting <= counted || (parting && !parted && !count_start);
        recording <= record_start || (recording && !record_done);
        making <= part_start || (making && !part_done);
        sending <= send_start || (sending && !sent);
        settling <= settling + {3'd0, last_read || (is_answered && with_bodies)} - {3'd0, settled};
        kept_before <= kept;
        if (reset) begin
            came <= 3'd0;
            went <= 3'd0;
            were_answered <= 3'd0;
            were_looked_at <= 3'd0;
            left <= 3'd0;
            frames <= 2'd0;
            bodies <= 2'd0;
            counting <= 1'b0;
            parting <= 1'b0;
            recording <= 1'b0;
            making <= 1'b0;
            sending <= 1'b0;
            settling <= 4'd0;
        end
    end

    always @(*) begin
        if (!started) begin
            assume (reset);
        end
        assume (!core_m_tvalid || (frames != 2'd0) || (bodies != 2'd0));
        assume (!counted || counting);
        assume (!parted || parting);
        assume (!record_done || recording);
        assume (!part_done || making);
        assume (!settled || (settling != 4'd0));
        assume (!parted_tvalid || sending);
        assume (output_idle == !leaves);
        assume (!frame_done || leaves);
        assume (kept <= CONTACTS);
        assume (counting || (kept == kept_before));
    end

    always @(posedge clock) begin
        if (started && !reset) begin
            // No place is taken twice: there is one for each frame that comes
            assert (!(s_tvalid && s_tready) || (here < BANKS));
            // In order, and each once: what goes, is answered, looked at and leaves is the frame whose turn it is
            assert (newest == came[0]);
            assert (oldest == went[0]);
            assert (newest_answer == were_answered[0]);
            assert (turn == were_looked_at[0]);
            assert (!(goes && !with_bodies) || (went != came));
            assert (!(is_answered && !with_bodies) || (were_answered != went));
            assert (!next || (to_look_at != 3'd0));
            // In the core are frames or those of bodies, and their answers are taken for what they are of
            assert ((frames == 2'd0) || (bodies == 2'd0));
            assert (!core_m_tvalid || (with_bodies == (bodies != 2'd0)));
            assert (!(core_s_tvalid && with_bodies) || ((frames == 2'd0) && !sends && !valid));
            assert (!core_s_tvalid || with_bodies || (bodies == 2'd0));
            // Fields and forces are read by one at a time
            assert (!(loads || with_bodies) || !leaves);
            // What is told to do something is not doing it
            assert (!(count_start && counting));
            assert (!(record_start && recording));
            assert (!(part_start && making));
            assert (!(send_start && sending));
            // A frame that is here is coming, on its way, in the core, looked at or leaving
            assert ((here == 3'd0) || (waiting != 2'd0) || sends || valid || (frames != 2'd0) || there || leaves);
        end
    end

    // ---- What is left to be done with the oldest frame: it falls with each step, and there is always somebody at work
    reg [5:0] steps;
    reg at_work;
    reg same = 1'b0;
    reg [5:0] steps_before;

    always @(*) begin
        at_work = 1'b1;
        case (state)
            IDLE: begin
                steps = 6'd40;
                at_work = (to_look_at == 3'd0) || there;
            end
            LARGEST: steps = 6'd39 - {4'd0, cycle};
            COUNTS: begin
                steps = 6'd35;
                at_work = begins || counting || copies || header_there || is_counted;
            end
            WAITS: begin
                steps = 6'd34;
                at_work = parting || is_parted;
            end
            LOADS: begin
                steps = 6'd33;
                at_work = begins || reads || load_valid || (settling != 4'd0);
            end
            DRAINS: begin
                steps = 6'd32;
                at_work = core_is_empty || sends || valid || (frames != 2'd0);
            end
            PARTS: begin
                steps = is_second ? 6'd20 : 6'd30;
                at_work = begins || making;
            end
            SENDS: begin
                steps = (is_second ? 6'd19 : 6'd29) - {2'd0, body};
                at_work = begins || sending;
            end
            ADDS: begin
                steps = (is_second ? 6'd16 : 6'd26) - {2'd0, answered};
                at_work = (answered == kept) || (settling != 4'd0) || (bodies != 2'd0);
            end
            RECORDS: begin
                steps = 6'd10;
                at_work = begins || recording;
            end
            default: begin
                steps = 6'd9;
                at_work = output_idle || leaves;
            end
        endcase
    end

    always @(posedge clock) begin
        same <= !reset && !next;
        steps_before <= steps;
        if (started && !reset) begin
            assert (at_work);
            assert (!same || (steps <= steps_before));
        end
    end

`ifdef INVARIANTS
    wire rounds = (state == PARTS) || (state == SENDS) || (state == ADDS);

    always @(posedge clock) begin
        if (started && !reset) begin
            // Numbers: each way from one to the next has as many frames as are counted there
            assert (here <= BANKS);
            assert ({1'b0, used} == here);
            assert (!has_place || (used != BANKS));
            assert ({1'b0, waiting} + {2'd0, sends || valid} == to_go);
            assert (!valid || (sends != last));
            assert (unanswered == frames);
            assert ({1'b0, frames} == gone);
            assert ({1'b0, looked_at} == to_look_at);
            assert (to_leave <= 3'd1);
            assert (to_go + gone + to_look_at + to_leave == here);
            assert (to_look_at <= BANKS);
            assert (to_go <= BANKS);
            assert (frames <= BANKS);
            // Steps
            assert (state <= LEAVES);
            assert (with_bodies == rounds);
            assert (hold == (rounds || (state == WAITS) || (state == LOADS) || (state == DRAINS)));
            assert (!is_second || with_bodies);
            assert ((state == IDLE) || there);
            assert (!with_bodies || ((frames == 2'd0) && !sends && !valid));
            assert (with_bodies || (bodies == 2'd0));
            assert ((state != LOADS && state != DRAINS && !rounds && state != RECORDS) || !leaves || !several);
            assert (!several || (kept > 4'd1) || (state == IDLE) || (state == LARGEST) || (state == COUNTS));
            assert (!hold || (several && (kept > 4'd1)));
            assert ((kept == kept_before) || counting || (state == COUNTS));
            // Who is at work
            assert (!counting || ((state == COUNTS) && !begins && !is_counted));
            assert (!copies || (state == COUNTS));
            assert ((state != WAITS) || parting || is_parted);
            assert ((state != COUNTS) || begins || counting || (is_counted && (parting || is_parted)));
            assert (making == ((state == PARTS) && !begins));
            assert (sending == ((state == SENDS) && !begins));
            assert (recording == ((state == RECORDS) && !begins));
            assert (!(reads || load_valid) || ((state == LOADS) && !begins && (settling == 4'd0)));
            assert ((state != LOADS) || ({3'd0, begins} + {3'd0, reads || load_valid} + settling == 4'd1));
            assert ((state == LOADS) || with_bodies || (settling == 4'd0));
            assert ((state != PARTS) || ((bodies == 2'd0) && (settling == 4'd0)));
            if ((state == PARTS) && !begins) begin
                assert ((body == 4'd0) && (answering == 4'd0) && (answered == 4'd0));
            end
            if ((state == SENDS) || (state == ADDS)) begin
                assert ((state == SENDS) ? (body < kept) : (body == kept));
                assert ({2'd0, bodies} == body - answering);
                assert (answering <= body);
                assert (answered <= answering);
                assert (settling == answering - answered);
            end
        end
    end
`endif

endmodule
