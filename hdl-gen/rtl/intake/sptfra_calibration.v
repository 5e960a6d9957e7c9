// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Two banks of a calibration: the active one, writes to the other, commit with CRC, and tare.
//
// A bank holds the taxels' gains, their offsets, the contact threshold and the noise floor. The words of
// sptfra_dead_bank and sptfra_curve_bank follow. A commit reads the other bank, six cycles a word. With the stated
// CRC and without contradiction it is active from the next frame on. Tare writes the active bank into the other one,
// with the mean stress taken off the offsets. The active bank outlives a reset: only the device's configuration
// brings the design's content back.

`default_nettype none

module sptfra_calibration #(
    // Taxels of a frame
    parameter TAXELS = 12,
    // Bits of an offset, in steps of the stress
    parameter OFFSET_BITS = 29,
    // Largest magnitude of an offset, in steps of the stress
    parameter signed [31:0] OFFSET_LIMIT = 32'sd134217728,
    // At power-up: least sum |b| of a contact and noise floor, in steps of the stress, and CRC of the bank
    parameter [31:0] CONTACT = 32'd1,
    parameter [26:0] NOISE = 27'd1,
    parameter [31:0] CRC = 32'd0,
    // Places of the map of dead taxels
    parameter REPLACEABLE = 0,
    // Words of a curve, see sptfra_curve_bank
    parameter CURVE_WORDS = 0,
    // Derived
    parameter TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1,
    parameter HAS_MORE = ((REPLACEABLE != 0) || (CURVE_WORDS != 0)) ? 1 : 0,
    parameter COMMAND_BITS = TAXEL_WIDTH + OFFSET_BITS + 31 + 56 * HAS_MORE,
    parameter WORDS_BITS = OFFSET_BITS + 28 + 34 * HAS_MORE
) (
    input  wire clock,
    input  wire reset,
    input  wire core_reset, // the frames inside are lost
    // Commands, one at a time, taken while idle
    output wire idle,
    output wire taring,
    input  wire [15:0] index, // the word to be read or written
    input  wire index_active, // of the active bank: read only
    input  wire write, // to the other one
    input  wire [31:0] write_data,
    output wire write_allowed,
    output reg  [31:0] word, // three cycles after index
    input  wire commit,
    input  wire [31:0] commit_crc,
    input  wire tare,
    input  wire [3:0] tare_log2,
    // Errors, one cycle
    output reg  wrong_crc,
    output reg  not_at_rest,
    output reg  bad_frame,
    output reg  tare_out_of_range,
    output reg  contradiction,
    // The active bank
    output reg  active,
    output reg  [7:0] version,
    output reg  [31:0] crc,
    // To the core, as of sptfra_bz
    output wire [67:0] active_calibration,
    input  wire old_in_use,
    output wire [COMMAND_BITS-1:0] bank_command,
    input  wire [WORDS_BITS-1:0] bank_words,
    output wire [TAXEL_WIDTH+4:0] tare_command,
    input  wire [29:0] tare_result
);

    localparam [31:0] OFFSETS_WIDE = TAXELS;
    localparam [31:0] CONTACT_WIDE = 2 * TAXELS;
    localparam [31:0] LAST_TAXEL_WIDE = TAXELS - 1;
    localparam [15:0] FIRST_OFFSET = OFFSETS_WIDE[15:0];
    localparam [15:0] CONTACT_WORD = CONTACT_WIDE[15:0];
    localparam [15:0] NOISE_WORD = CONTACT_WORD + 16'd1;
    localparam [31:0] MAP_WORDS = (REPLACEABLE != 0) ? 1 + REPLACEABLE + REPLACEABLE * TAXELS : 0;
    localparam [31:0] MORE_WORDS = MAP_WORDS + CURVE_WORDS;
    localparam [15:0] LAST_WORD = NOISE_WORD + MORE_WORDS[15:0];
    localparam [15:0] LAST_TAXEL = LAST_TAXEL_WIDE[15:0];
    localparam [2:0] IDLE = 3'd0, WALK = 3'd1, DECIDE = 3'd2, DRAIN = 3'd3, GATHER = 3'd4, COPY = 3'd5;
    localparam [2:0] LAST_BYTE = 3'd5; // of a word's cycles
    localparam [2:0] COPY_TAKES = 3'd3, COPY_WRITES = 3'd5;

    reg [2:0] state;
    reg [2:0] step; // cycles at a word
    reg [15:0] place;
    reg checks; // whether the CRC must be the stated one
    reg [31:0] expected;
    reg [31:0] sum; // of the CRC
    reg [63:0] contacts; // bank 1, bank 0
    reg [53:0] noises;
    reg [3:0] tare_frames; // their logarithm
    wire tare_finished, tare_restless, tare_bad_frame;
    wire signed [26:0] tare_mean;
    wire copy_writes = (state == COPY) && (step == COPY_WRITES);
    // Or of the other one: the active one is read, and never written.
    wire of_active = (state == IDLE) ? (index_active && !write) : (state == COPY) && !copy_writes;
    wire bank = of_active ? active : !active;

    // Configuration, not reset, brings the design's content
    initial begin
        active = 1'b0;
        version = 8'd0;
        crc = CRC;
        contacts = {CONTACT, CONTACT};
        noises = {NOISE, NOISE};
    end

    assign idle = (state == IDLE);
    assign taring = (state == GATHER) || (state == COPY);
    assign active_calibration = {active, version, active ? contacts[63:32] : contacts[31:0],
        active ? noises[53:27] : noises[26:0]};
    assign tare_command = {taring, tare_frames, place[TAXEL_WIDTH-1:0]};
    assign {tare_finished, tare_restless, tare_bad_frame, tare_mean} = tare_result;

    // ---- The word of a bank: its place, then its content
    wire [15:0] position = (state == IDLE) ? index : place;
    wire of_gain = (position < FIRST_OFFSET);
    wire of_offset = !of_gain && (position < CONTACT_WORD);
    wire of_contact = (position == CONTACT_WORD);
    wire of_noise = (position == NOISE_WORD);
    wire of_more = (position > NOISE_WORD) && (position <= LAST_WORD);
    wire [15:0] taxel = of_gain ? position : position - FIRST_OFFSET;
    reg [4:0] kind; // of the word that the memories show
    reg kind_bank;
    wire [27:0] bank_gain = bank_words[OFFSET_BITS +: 28];
    wire [OFFSET_BITS-1:0] bank_offset = bank_words[OFFSET_BITS-1:0];
    wire [33:0] more_result; // of map and curve: see sptfra_dead_bank

    if (HAS_MORE != 0) begin : gen_more
        assign more_result = bank_words[OFFSET_BITS+28 +: 34];
    end else begin : gen_thresholds_last
        assign more_result = 34'd0;
    end

    always @(posedge clock) begin
        kind <= {of_more, of_noise, of_contact, of_offset, of_gain};
        kind_bank <= bank;
        word <= (kind[0] ? {4'd0, bank_gain} : 32'd0)
            | (kind[1] ? {{(32-OFFSET_BITS){bank_offset[OFFSET_BITS-1]}}, bank_offset} : 32'd0)
            | (kind[2] ? (kind_bank ? contacts[63:32] : contacts[31:0]) : 32'd0)
            | (kind[3] ? {5'd0, kind_bank ? noises[53:27] : noises[26:0]} : 32'd0)
            | (kind[4] ? more_result[31:0] : 32'd0);
    end

    // ---- Bounds: a mantissa has all of its bits in use; the rest is what the numbers behind have room for
    wire [17:0] mantissa = write_data[17] ? -write_data[17:0] : write_data[17:0];
    wire gain_fits = (write_data[31:28] == 4'd0) && (mantissa[17:16] == 2'b01);
    wire offset_fits = ($signed(write_data) <= OFFSET_LIMIT) && ($signed(write_data) >= -OFFSET_LIMIT);
    wire noise_fits = (write_data[31:26] == 6'd0) && (write_data[25:0] != 26'd0);

    assign write_allowed = (of_gain && gain_fits) || (of_offset && offset_fits)
        || (of_contact && (write_data != 32'd0)) || (of_noise && noise_fits) || (of_more && more_result[32]);

    // ---- Tare: offsets of the active bank, less what the frames had
    reg [27:0] copied_gain;
    reg signed [31:0] new_offset;
    wire new_offset_fits = (new_offset <= OFFSET_LIMIT) && (new_offset >= -OFFSET_LIMIT);
    wire writes = write && idle;
    wire new_contact = writes && of_contact && (write_data != 32'd0);
    wire new_noise = writes && of_noise && noise_fits;
    wire copy_ends = copy_writes && (place == LAST_TAXEL);
    wire copies_taxel = copy_writes && new_offset_fits;
    wire [TAXEL_WIDTH+OFFSET_BITS+86:0] command = {
        // Of map and curve
        state == COPY,
        (state == COPY) && (step == COPY_TAKES),
        copies_taxel,
        copy_ends,
        state == IDLE,
        (state == WALK) && (step == LAST_BYTE) && of_more,
        writes && of_more,
        bank,
        position,
        write_data,
        // Of gains and offsets
        (writes && of_gain && gain_fits) || copies_taxel,
        (writes && of_offset && offset_fits) || copies_taxel,
        bank,
        taxel[TAXEL_WIDTH-1:0],
        idle ? write_data[27:0] : copied_gain,
        idle ? write_data[OFFSET_BITS-1:0] : new_offset[OFFSET_BITS-1:0]
    };

    assign bank_command = command[COMMAND_BITS-1:0];

    // ---- CRC-32 as of Ethernet and zlib, a byte a cycle, the lowest first
    wire [1:0] byte_place = step[1:0] - 2'd2;
    wire [7:0] next_byte = word[{byte_place, 3'd0} +: 8];
    wire [31:0] crc_end = ~sum;

    function [31:0] crc_of_byte;
        input [31:0] value;
        integer position_bit;
        begin
            crc_of_byte = value;
            for (position_bit = 0; position_bit < 8; position_bit = position_bit + 1) begin
                crc_of_byte = {1'b0, crc_of_byte[31:1]} ^ (crc_of_byte[0] ? 32'hedb88320 : 32'd0);
            end
        end
    endfunction

    wire wrong = checks && (crc_end != expected);

    // ---- Commands
    always @(posedge clock) begin
        wrong_crc <= 1'b0;
        not_at_rest <= 1'b0;
        bad_frame <= 1'b0;
        tare_out_of_range <= 1'b0;
        contradiction <= 1'b0;
        step <= step + 3'd1;
        case (state)
            IDLE: begin
                place <= 16'd0;
                step <= 3'd0;
                sum <= 32'hffffffff;
                expected <= commit_crc;
                checks <= commit;
                tare_frames <= tare_log2;
                state <= commit ? WALK : tare ? GATHER : IDLE;
            end
            GATHER: begin
                step <= 3'd0;
                if (tare_finished) begin
                    not_at_rest <= tare_restless;
                    bad_frame <= tare_bad_frame;
                    state <= (tare_restless || tare_bad_frame) ? IDLE : COPY;
                end
            end
            COPY: begin
                if (step == COPY_TAKES) begin
                    copied_gain <= bank_gain;
                    new_offset <= {{(32-OFFSET_BITS){bank_offset[OFFSET_BITS-1]}}, bank_offset}
                        - {{5{tare_mean[26]}}, tare_mean};
                end
                if (copy_writes) begin
                    step <= 3'd0;
                    place <= place + 16'd1;
                    tare_out_of_range <= !new_offset_fits;
                    if (!new_offset_fits) begin
                        state <= IDLE;
                    end else if (place == LAST_TAXEL) begin
                        place <= 16'd0;
                        state <= WALK;
                    end
                end
            end
            WALK: begin
                if (step >= 3'd2) begin
                    sum <= crc_of_byte(sum ^ {24'd0, next_byte});
                end
                if (step == LAST_BYTE) begin
                    step <= 3'd0;
                    place <= place + 16'd1;
                    state <= (place == LAST_WORD) ? DECIDE : WALK;
                end
            end
            DECIDE: begin
                wrong_crc <= wrong;
                contradiction <= !wrong && more_result[33];
                state <= (wrong || more_result[33]) ? IDLE : DRAIN;
            end
            // The frame coming in may still need the other bank
            default: begin
                if (!old_in_use) begin
                    state <= IDLE;
                end
            end
        endcase
        if (core_reset && taring) begin
            bad_frame <= 1'b1;
            state <= IDLE;
        end
        if (reset) begin
            state <= IDLE;
            wrong_crc <= 1'b0;
            not_at_rest <= 1'b0;
            bad_frame <= 1'b0;
            tare_out_of_range <= 1'b0;
            contradiction <= 1'b0;
        end
    end

    // ---- The active bank, and both banks' thresholds

    always @(posedge clock) begin
        if ((state == DECIDE) && !wrong && !more_result[33] && !reset) begin
            active <= !active;
            version <= version + 8'd1;
            crc <= crc_end;
        end
        if ((new_contact && active) || (copy_ends && active)) begin
            contacts[31:0] <= idle ? write_data : contacts[63:32];
        end
        if ((new_contact && !active) || (copy_ends && !active)) begin
            contacts[63:32] <= idle ? write_data : contacts[31:0];
        end
        if ((new_noise && active) || (copy_ends && active)) begin
            noises[26:0] <= idle ? write_data[26:0] : noises[53:27];
        end
        if ((new_noise && !active) || (copy_ends && !active)) begin
            noises[53:27] <= idle ? write_data[26:0] : noises[26:0];
        end
    end

    wire _unused = &{1'b0, command, taxel, mantissa[15:0], OFFSETS_WIDE[31:16], CONTACT_WIDE[31:16],
        LAST_TAXEL_WIDE[31:16], MORE_WORDS[31:16]};

endmodule

`default_nettype wire
