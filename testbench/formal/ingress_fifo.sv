// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Ingress FIFO that drops frames: the source is never held. A frame that begins while fewer than two wait is handed on
// whole, beat by beat and in order, however long it is. Of any other not a beat is. A frame that is kept says whether
// frames were dropped before it.
//
// A queue of beats stands beside the FIFO, filled by the rule alone. Frames of two beats, so that three
// are stored of one that is too long, and six in all.
module harness (
    input wire clock,
    input wire reset,
    input wire [31:0] s_tdata,
    input wire s_tlast,
    input wire s_tvalid,
    input wire m_tready
);

    localparam BEATS = 2;
    localparam LENGTH = BEATS + 1;
    localparam DEPTH = 2 * LENGTH;

    wire s_tready;
    wire kept;
    wire dropped;
    wire [31:0] m_tdata;
    wire m_tlast;
    wire m_tvalid;
    wire follows_dropped;
    wire in_frame;
    wire keeps;
    wire [1:0] frames;
    wire [1:0] index;
    wire [2:0] write_address;
    wire [2:0] read_address;
    wire [2:0] waiting;
    wire [33*DEPTH-1:0] ring;

    sptfra_ingress_fifo subject (
        .clock      (clock),
        .reset      (reset),
        .s_tdata    (s_tdata),
        .s_tlast    (s_tlast),
        .s_tvalid   (s_tvalid),
        .s_tready   (s_tready),
        .kept       (kept),
        .dropped    (dropped),
        .follows_dropped (follows_dropped),
        .m_tdata    (m_tdata),
        .m_tlast    (m_tlast),
        .m_tvalid   (m_tvalid),
        .m_tready   (m_tready),
        // Inside
        .\whole_frames.in_frame (in_frame),
        .\whole_frames.keeps (keeps),
        .frames        (frames),
        .index         (index),
        .write_address (write_address),
        .read_address  (read_address),
        .waiting       (waiting),
        .\ring.words   (ring)
    );

    // ---- The rule: two frames wait, a third one is dropped
    reg started = 1'b0;
    reg open;
    reg has_room; // the frame coming in
    reg [1:0] stored; // beats of it, BEATS at most
    reg [1:0] inside;
    wire taken = s_tvalid && s_tready;
    wire room = open ? has_room : (inside != 2'd2);
    wire begins = taken && room && !open;
    wire push = taken && room && ((stored != BEATS) || s_tlast);

    // ---- Beats that wait, the oldest in the lowest bits
    reg [33*DEPTH-1:0] queue;
    reg [2:0] held;
    wire given = m_tvalid && m_tready;
    wire [2:0] left = held - {2'd0, given};
    wire [33*DEPTH-1:0] shifted = given ? queue >> 33 : queue;

    reg after_dropped; // frames, since the last one that has room
    integer place;

    always @(posedge clock) begin
        started <= 1'b1;
        if (taken) begin
            open <= !s_tlast;
            has_room <= room;
            stored <= (s_tlast || !room) ? 2'd0 : push ? stored + 2'd1 : stored;
        end
        inside <= inside + {1'b0, begins} - {1'b0, given && queue[32]};
        queue <= shifted;
        if (push) begin
            queue[33*left +: 33] <= {s_tlast, s_tdata};
        end
        held <= left + {2'd0, push};
        if (begins) begin
            after_dropped <= 1'b0;
        end
        if (taken && s_tlast && !room) begin
            after_dropped <= 1'b1;
        end
        if (reset) begin
            open <= 1'b0;
            stored <= 2'd0;
            inside <= 2'd0;
            held <= 3'd0;
            after_dropped <= 1'b0;
        end
    end

    always @(*) begin
        if (!started) begin
            assume (reset);
        end
    end

    // ---- What was on offer in the cycle before
    reg after_reset = 1'b1;
    reg waited = 1'b0;
    reg arrived = 1'b0;
    reg [32:0] offered;

    always @(posedge clock) begin
        after_reset <= reset;
        waited <= m_tvalid && !m_tready && !reset;
        arrived <= !m_tvalid && (held != 3'd0) && !reset;
        offered <= {m_tlast, m_tdata};
    end

    always @(posedge clock) begin
        if (started) begin
            // The source is never held
            assert (s_tready == !after_reset);
            // A frame is kept or dropped, all of it
            assert (kept == (taken && room));
            assert (dropped == (taken && s_tlast && !room));
            // No beat of those kept is lost, doubled or out of order, and there is room for it
            assert (!m_tvalid || ((held != 3'd0) && ({m_tlast, m_tdata} == queue[32:0])));
            assert (!push || (left < DEPTH));
            // A beat that is offered stays, and one that is held is offered
            assert (!waited || (m_tvalid && ({m_tlast, m_tdata} == offered)));
            assert (!arrived || m_tvalid);
            // The first beat of a frame that is kept says whether frames were dropped before it
            assert (!begins || (follows_dropped == after_dropped));
        end
    end

`ifdef INVARIANTS
    // Ends of frames that wait, and beats behind the last one
    reg [2:0] ends;
    reg [2:0] behind;
    reg too_long; // more beats than are stored of a frame lie between two ends
    wire coming = open && has_room;

    always @(*) begin
        ends = 3'd0;
        behind = 3'd0;
        too_long = 1'b0;
        for (place = 0; place < DEPTH; place = place + 1) begin
            if (place < held) begin
                behind = behind + 3'd1;
                too_long = too_long || (behind > LENGTH);
                if (queue[33*place+32]) begin
                    ends = ends + 3'd1;
                    behind = 3'd0;
                end
            end
        end
    end

    // The place of the first beat that has not been read
    wire [2:0] first = m_tvalid ? 3'd1 : 3'd0;
    reg [3:0] at;
    reg same;

    always @(*) begin
        same = 1'b1;
        for (place = 0; place < DEPTH; place = place + 1) begin
            at = read_address + place;
            at = (at >= DEPTH) ? at - DEPTH : at;
            if (place < waiting) begin
                same = same && (ring[33*at +: 33] == queue[33*(place + first) +: 33]);
            end
        end
    end

    always @(posedge clock) begin
        if (started) begin
            assert (in_frame == open);
            assert (!open || (keeps == has_room));
            assert (frames == inside);
            assert (index == stored);
            assert (stored <= BEATS);
            assert ((stored != 2'd0) == (open && has_room));
            assert ({1'b0, inside} == ends + {2'd0, coming});
            assert (inside <= 2'd2);
            assert (!too_long);
            assert (coming ? ((ends != 3'd0) ? (behind == stored) : (behind <= stored)) : (behind == 3'd0));
            assert (held <= DEPTH);
            assert ({1'b0, held} == {1'b0, waiting} + {3'd0, m_tvalid});
            assert (read_address < DEPTH);
            assert (write_address == (({1'b0, read_address} + waiting >= DEPTH) ? read_address + waiting - DEPTH
                : read_address + waiting));
            assert (same);
            assert (follows_dropped == after_dropped);
        end
    end
`endif

endmodule
