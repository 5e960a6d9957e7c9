// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The registers behind the AXI4-Lite port: what the design is, soft reset, status, interrupts, counters.
//
// Reads answer in the same cycle. Counts frames and measures their cycles at the core's two streams. Sixteen frames may
// be inside. A soft reset clears the counters. Interrupts and the rate of the average stay.
// The map is that of the design's control/NAME.rdl.

`default_nettype none

module sptfra_registers #(
    // Words 0 to 10, what the design is; the first in the lowest bits
    parameter [11*32-1:0] CONSTANTS = {11{32'd0}},
    // Frames that find no room are dropped
    parameter [0:0] DROPS = 1'd0,
    // k of the average over frames after reset, 1 to 8; 0: frames are not averaged
    parameter [3:0] SMOOTHING_RATE = 4'd0
) (
    input  wire clock,
    input  wire reset,
    // Accesses
    input  wire write_enable,
    input  wire [9:0] write_word,
    input  wire [31:0] write_data,
    input  wire [31:0] write_mask,
    output wire write_mapped,
    input  wire [9:0] read_word,
    output reg  [31:0] read_data,
    output wire read_mapped,
    // Soft reset
    output wire soft_reset, // for one cycle
    input  wire resetting,
    input  wire discarding,
    input  wire receiving,
    input  wire sending,
    // The core's streams
    input  wire restart, // of the core: by reset or soft reset
    input  wire in_taken,
    input  wire in_last,
    input  wire out_taken,
    input  wire out_last,
    input  wire [31:0] out_word,
    input  wire dropped, // a frame, for one cycle
    // Events
    input  wire bad_access,
    output reg  irq,
    // k from the next frame on, 8 at most
    output wire [3:0] smoothing
);

    // Addresses, in words
    localparam [9:0] CONSTANT_WORDS = 10'd11;
    localparam [9:0] CONTROL = 10'd16;
    localparam [9:0] STATUS = 10'd17;
    localparam [9:0] INTERRUPT_ENABLE = 10'd18;
    localparam [9:0] INTERRUPT_STATUS = 10'd19;
    localparam [9:0] FRAMES_IN = 10'd20;
    localparam [9:0] FRAMES_OUT = 10'd21;
    localparam [9:0] FRAMES_BAD = 10'd22;
    localparam [9:0] LAST_STATUS = 10'd23;
    localparam [9:0] LAST_LATENCY = 10'd24;
    localparam [9:0] LAST_INTERVAL = 10'd25;
    localparam [9:0] FRAMES_DROPPED = 10'd26;
    localparam [9:0] SMOOTHING = 10'd27;
    localparam [0:0] AVERAGES = (SMOOTHING_RATE != 4'd0);

    function is_mapped(input [9:0] word);
        is_mapped = (word < CONSTANT_WORDS) || ((word >= CONTROL) && (word <= LAST_INTERVAL))
            || (DROPS && (word == FRAMES_DROPPED)) || (AVERAGES && (word == SMOOTHING));
    endfunction

    reg [2:0] enabled;
    reg [2:0] pending;
    reg [3:0] rate;

    assign write_mapped = is_mapped(write_word);
    assign read_mapped = is_mapped(read_word);
    assign smoothing = rate[3] ? 4'd8 : rate;

    // ---- Frames and their cycles
    reg [31:0] frames_in;
    reg [31:0] frames_out;
    reg [31:0] frames_bad;
    reg [31:0] last_status;
    reg [31:0] last_latency;
    reg [31:0] last_interval;
    reg [31:0] frames_dropped;
    // For one cycle, after a frame's last beat
    reg frame_done;
    reg frame_error;
    reg [31:0] now;
    reg in_frame;
    reg out_frame;
    reg [31:0] status; // of the frame going out
    // When each frame inside began
    reg [31:0] beginnings [0:15];
    reg [3:0] newest;
    reg [3:0] oldest;
    reg [31:0] last_end;
    reg seen_end;

    wire frame_ends = out_taken && out_last;
    wire faulty = (status[5:4] != 2'd0);

    always @(posedge clock) begin
        now <= now + 32'd1;
        if (in_taken) begin
            in_frame <= !in_last;
            if (!in_frame) begin
                beginnings[newest] <= now;
                newest <= newest + 4'd1;
            end
            if (in_last) begin
                frames_in <= frames_in + 32'd1;
            end
        end
        if (out_taken) begin
            out_frame <= !out_last;
            if (!out_frame) begin
                status <= out_word;
            end
        end
        frames_dropped <= frames_dropped + {31'd0, dropped};
        frame_done <= frame_ends;
        frame_error <= frame_ends && faulty;
        if (frame_ends) begin
            frames_out <= frames_out + 32'd1;
            frames_bad <= frames_bad + {31'd0, faulty};
            last_status <= status;
            last_latency <= now - beginnings[oldest] + 32'd1;
            last_interval <= seen_end ? now - last_end : 32'd0;
            last_end <= now;
            seen_end <= 1'b1;
            oldest <= oldest + 4'd1;
        end
        if (restart) begin
            now <= 32'd0;
            in_frame <= 1'b0;
            out_frame <= 1'b0;
            newest <= 4'd0;
            oldest <= 4'd0;
            seen_end <= 1'b0;
            frames_in <= 32'd0;
            frames_out <= 32'd0;
            frames_bad <= 32'd0;
            last_status <= 32'd0;
            last_latency <= 32'd0;
            last_interval <= 32'd0;
            frames_dropped <= 32'd0;
            frame_done <= 1'b0;
            frame_error <= 1'b0;
        end
    end

    // ---- Reads
    always @(*) begin
        case (read_word)
            STATUS: read_data = {28'd0, sending, receiving, discarding, resetting};
            INTERRUPT_ENABLE: read_data = {29'd0, enabled};
            INTERRUPT_STATUS: read_data = {29'd0, pending};
            FRAMES_IN: read_data = frames_in;
            FRAMES_OUT: read_data = frames_out;
            FRAMES_BAD: read_data = frames_bad;
            LAST_STATUS: read_data = last_status;
            LAST_LATENCY: read_data = last_latency;
            LAST_INTERVAL: read_data = last_interval;
            FRAMES_DROPPED: read_data = DROPS ? frames_dropped : 32'd0;
            SMOOTHING: read_data = AVERAGES ? {28'd0, rate} : 32'd0;
            // CONTROL reads as zero
            default: read_data = (read_word < CONSTANT_WORDS) ? CONSTANTS[{read_word[3:0], 5'd0} +: 32] : 32'd0;
        endcase
    end

    // ---- Writes
    wire [2:0] ones = write_data[2:0] & write_mask[2:0];
    wire [2:0] events = {bad_access, frame_error, frame_done};
    wire [2:0] cleared = (write_enable && (write_word == INTERRUPT_STATUS)) ? ones : 3'd0;

    assign soft_reset = write_enable && (write_word == CONTROL) && ones[0];

    always @(posedge clock) begin
        if (write_enable && (write_word == INTERRUPT_ENABLE)) begin
            enabled <= (enabled & ~write_mask[2:0]) | ones;
        end
        if (write_enable && (write_word == SMOOTHING)) begin
            rate <= (rate & ~write_mask[3:0]) | (write_data[3:0] & write_mask[3:0]);
        end
        // An event in the cycle in which its bit is cleared is not lost
        pending <= (pending & ~cleared) | events;
        irq <= ((pending & enabled) != 3'd0);
        if (reset) begin
            enabled <= 3'd0;
            pending <= 3'd0;
            irq <= 1'b0;
            rate <= SMOOTHING_RATE;
        end
    end

    wire _unused = &{1'b0, write_data[31:4], write_mask[31:4]};

endmodule

`default_nettype wire
