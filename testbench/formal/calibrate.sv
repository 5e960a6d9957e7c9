// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Calibration in RAM: every beat of a frame reads the bank that acted at the frame's first one, nothing is written there
// meanwhile, no frame begins while the one before is held, and no more ends of frames are on their way than are counted.
//
// The banks' control is what is assumed here: it writes the bank that does not act, and changes banks, only while no
// frame coming in needs the other one.
module harness (
    input wire clock,
    input wire [31:0] s_tdata,
    input wire s_tlast,
    input wire s_tvalid,
    input wire m_tready,
    input wire tare_run,
    input wire change,
    input wire write_gain,
    input wire write_offset,
    input wire [4:0] address,
    input wire whole // the frame that began last is held no more: where dead taxels are replaced, once its sums are there
);

    reg started = 1'b0;
    reg active = 1'b0;
    wire reset = !started;
    wire s_tready;
    wire old_in_use;
    wire frame_begins;
    wire advance;
    wire bank;
    wire bank_held;
    wire marked;
    wire marked_held;
    wire in_frame;
    wire [1:0] ends_inside;
    wire reading_valid;
    wire reading_last;
    reg held;
    wire [17:1] valid;
    wire [17:1] lasts;

    sptfra_calibrate subject (
        .clock        (clock),
        .reset        (reset),
        .s_tdata      (s_tdata),
        .s_tlast      (s_tlast),
        .s_tvalid     (s_tvalid),
        .s_tready     (s_tready),
        .m_tready     (m_tready),
        .active       (active),
        .old_in_use   (old_in_use),
        .frame_begins (frame_begins),
        .bank_held    (bank_held),
        .hold         (held),
        .reading_valid (reading_valid),
        .reading_last (reading_last),
        .back_valid   (reading_valid),
        .back_last    (reading_last),
        .write_gain   (write_gain),
        .write_offset (write_offset),
        .address      (address),
        .tare_run     (tare_run),
        // Inside
        .advance      (advance),
        .bank         (bank),
        .marked       (marked),
        .marked_held  (marked_held),
        .in_frame     (in_frame),
        .ends_inside  (ends_inside),
        .valid        (valid),
        .lasts        (lasts)
    );

    // ---- The frame coming in, and what acted at its first beat
    wire taken = s_tvalid && s_tready;
    wire writes = write_gain || write_offset;
    reg open;
    reg its_bank;
    reg its_mark;

    always @(posedge clock) begin
        started <= 1'b1;
        active <= active ^ change;
        if (taken) begin
            open <= !s_tlast;
            its_bank <= open ? its_bank : active;
            its_mark <= open ? its_mark : tare_run;
        end
        if (!tare_run) begin
            its_mark <= 1'b0;
        end
        if (reset) begin
            open <= 1'b0;
        end
        held <= !reset && (held || frame_begins) && !whole;
    end

    always @(*) begin
        assume (!change || !old_in_use);
        assume (!writes || (!old_in_use && (address[4] != active)));
    end

    always @(posedge clock) begin
        if (!reset) begin
            // One bank for a frame, and a tare has it whole or not at all: from its first beat on, without an end between
            assert (!taken || (bank == (open ? its_bank : active)));
            assert (!taken || (marked == (open ? its_mark : tare_run)));
            assert (frame_begins == (taken && !open));
            // What it needs is not written
            assert (!(writes && (open || held) && (address[4] == its_bank)));
            assert (old_in_use == ((open || held) && (its_bank != active)));
            assert (!(frame_begins && held));
            // Whoever waits is served
            assert (s_tready || !advance || (!in_frame && (held || (ends_inside == 2'd3))));
        end
    end

`ifdef INVARIANTS
    wire [17:1] ends = valid & lasts;
    wire [4:0] count = {4'd0, ends[1]} + ends[2] + ends[3] + ends[4] + ends[5] + ends[6] + ends[7] + ends[8] + ends[9]
        + ends[10] + ends[11] + ends[12] + ends[13] + ends[14] + ends[15] + ends[16] + ends[17];

    always @(posedge clock) begin
        if (!reset) begin
            assert (in_frame == open);
            assert (!(open || held) || (bank_held == its_bank));
            assert (!open || (marked_held == its_mark));
            assert (!open || (count <= 5'd2));
            assert ({3'd0, ends_inside} == count);
        end
    end
`endif

endmodule
